// Any text as a clump template. The reader either throws an Error with the file's name or gives a clump whose text reproduces it.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.hpp"
#include "io/clump_file.hpp"

using namespace pelletlab;

namespace {

void require(bool condition) {
    if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    ClumpTemplate clump;
    try {
        clump = io::parse_clump(std::string(reinterpret_cast<const char*>(bytes), size), "f.clump.toml");
    } catch (const Error& error) {
        require(error.kind() == ErrorKind::bad_input);
        require(!error.place().file.empty() && !error.problem().empty() && !error.remedy().empty());
        return 0;
    }
    const std::string text = io::clump_text(clump);
    const ClumpTemplate back = io::parse_clump(text, "again.clump.toml");
    require(io::clump_text(back) == text);
    require(back.rigid.spheres.size() == clump.rigid.spheres.size());
    return 0;
}
