// Any bytes as the files of one importer (PELLETLAB_FUZZ_FORMAT names it). A line «%%» starts the next file: companions follow the main one; a first line «?»
// withholds the units. The reader either throws an Error with a problem and the file's name, or gives finite spheres; a complete clump survives another export.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/error.hpp"
#include "shapegen/formats/formats.hpp"

using namespace pelletlab;
using namespace pelletlab::shapegen::formats;

namespace {

void require(bool condition) {
    if (!condition) std::abort();
}

std::vector<FormatFile> files_of(std::string_view text) {
    static const char* const names[] = {"main.txt", "a/Mass.txt", "a/TOI.txt", "a/PD.txt"};
    std::vector<FormatFile> files;
    while (files.size() < 4) {
        const std::size_t cut = text.find("\n%%\n");
        files.push_back({names[files.size()], std::string(text.substr(0, cut == std::string_view::npos ? cut : cut + 1))});
        if (cut == std::string_view::npos) break;
        text.remove_prefix(cut + 4);
    }
    return files;
}

void check_error(const Error& error) {
    require(error.kind() == ErrorKind::bad_input);
    require(!error.problem().empty());
    require(error.place().line >= 0 && error.place().column >= 0);
}

/// Written in metres and kilograms and read again, the spheres are the same to the precision of the format.
void check_round_trip(const Format& format, const RigidTemplate& rigid) {
    ClumpTemplate clump;
    clump.rigid = rigid;
    std::vector<FormatFile> files;
    try {
        files = format.write(clump, {"m", "kg", 1, 1, 0.0});
    } catch (const Error& error) {  // the program cannot take this clump
        require(error.kind() == ErrorKind::bad_input && !error.problem().empty());
        return;
    }
    for (const FormatFile& file : files)
        for (const char c : file.content) require(c == '\n' || c == '\t' || (c >= ' ' && c <= '~'));
    const ImportedClump again = format.read(files, {"m", "kg"});
    require(again.spheres.size() == rigid.spheres.size());
    for (std::size_t i = 0; i < rigid.spheres.size(); ++i) {
        const double tolerance = 2.0 * format.precision * rigid.bounding_radius + 1e-29;  // MercuryDPM: nothing below 1e-30
        require((again.spheres[i].centre - rigid.spheres[i].centre).cwiseAbs().maxCoeff() <= tolerance);
        require(std::abs(again.spheres[i].radius - rigid.spheres[i].radius) <= tolerance);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const Format& format = find(PELLETLAB_FUZZ_FORMAT);
    std::string_view text(reinterpret_cast<const char*>(bytes), size);
    ReadOptions options{"mm", "g"};
    if (text.substr(0, 2) == "?\n") {
        options = {};
        text.remove_prefix(2);
    }
    const std::vector<FormatFile> files = files_of(text);
    ImportedClump clump;
    try {
        clump = format.read(files, options);
    } catch (const Error& error) {
        check_error(error);
        require(!error.place().file.empty());
        return 0;
    }
    require(!clump.spheres.empty());
    for (const Sphere& sphere : clump.spheres) require(sphere.centre.allFinite() && std::isfinite(sphere.radius) && sphere.radius > 0.0);
    RigidTemplate rigid;
    try {
        rigid = rigid_template(clump, 1500.0);
    } catch (const Error& error) {
        check_error(error);
        return 0;
    }
    require(rigid.spheres.size() == clump.spheres.size());
    check_round_trip(format, rigid);
    return 0;
}
