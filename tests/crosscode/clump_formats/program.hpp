// Other people's programs, run as a whole in a folder of their own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "shapegen/formats/formats.hpp"

namespace pelletlab::crosscode {

/// Full path of the program found through PATH; empty when it is not installed.
std::string find_program(const std::string& name);

/// An empty folder that is removed at the end.
class Folder {
public:
    Folder();
    ~Folder();
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::filesystem::path path;
    void write(const std::string& name, const std::string& content) const;
    void write(const std::vector<shapegen::formats::FormatFile>& files) const;
    std::string read(const std::string& name) const;
    /// Runs the command there, at most three minutes; its output goes to output.txt. Returns the exit status.
    int run(const std::string& command) const;
};

/// Numbers of the line that starts with `start`, from there on.
std::vector<double> numbers_after(const std::string& text, const std::string& start);

/// The pellet of all these tests: 24 spheres, nothing symmetric, principal moments 5.0, 5.5, 6.0 e-11 kg m².
ClumpTemplate unlike_pellet();

}  // namespace pelletlab::crosscode
