// Any text as a case file; text behind a zero byte is one override a line. The reader either throws an Error with the file's name or gives a case that its
// resolved text reproduces.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "io/case_file.hpp"

using namespace pelletlab;

namespace {

void require(bool condition) {
    if (!condition) std::abort();
}

/// Overrides come from the command line and may hold bytes that no TOML file may: then the resolved text cannot be read back.
bool is_ascii(const std::string& text) {
    for (const char c : text)
        if (static_cast<unsigned char>(c) >= 0x80) return false;
    return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const std::string input(reinterpret_cast<const char*>(bytes), size);
    const std::size_t zero = std::min(input.find('\0'), input.size());
    std::vector<std::string> overrides;
    for (std::size_t begin = zero + 1; begin < input.size();) {
        const std::size_t end = std::min(input.find('\n', begin), input.size());
        overrides.push_back(input.substr(begin, end - begin));
        begin = end + 1;
    }
    Case c;
    try {
        c = io::parse_case(input.substr(0, zero), "f.toml", overrides);
    } catch (const Error& error) {
        require(error.kind() == ErrorKind::bad_input);
        require(!error.place().file.empty() && !error.problem().empty() && !error.remedy().empty());
        return 0;
    }
    if (zero < input.size() && !is_ascii(input.substr(zero))) return 0;
    const std::string text = io::resolved_case_text(c);
    require(io::parse_case(text, "resolved.toml") == c);
    return 0;
}
