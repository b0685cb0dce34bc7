// The one error type of PelletLab. Wrong input is an exception that says where, what is wrong and what to do;
// an expected numerical outcome (a fit that stopped early, a bed not at rest) is data with a status, not an Error.
#pragma once

#include <stdexcept>
#include <string>

namespace pelletlab {

/// What went wrong, and the exit code with which the command line ends.
enum class ErrorKind {
    usage = 2,         ///< the command line itself is wrong
    bad_input = 3,     ///< a file, a value or a mesh cannot be used
    numerical = 4,     ///< a computation failed: unstable step, escaped pellet, NaN
    interrupted = 130  ///< Ctrl-C or SIGTERM
};

/// A place in a text file; line and column count from 1, and 0 means «not known».
struct Place {
    std::string file;
    int line = 0;
    int column = 0;
};

class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, std::string problem, std::string remedy = {}, Place place = {});

    ErrorKind kind() const { return kind_; }
    int exit_code() const { return static_cast<int>(kind_); }
    const std::string& problem() const { return problem_; }
    const std::string& remedy() const { return remedy_; }
    const Place& place() const { return place_; }

private:
    ErrorKind kind_;
    std::string problem_;
    std::string remedy_;
    Place place_;
};

/// Shorthands: `throw bad_input("the mesh is empty", "export it again", {path});`
Error usage_error(std::string problem, std::string remedy = {});
Error bad_input(std::string problem, std::string remedy = {}, Place place = {});
Error numerical_failure(std::string problem, std::string remedy = {}, Place place = {});

/// The candidate closest to `word` (edit distance ≤ 1/3 of its length, at least 2), or an empty string: «did you mean …?».
template <class Range>
std::string closest_word(const std::string& word, const Range& candidates);

/// Number of single-letter insertions, deletions and substitutions that turn `a` into `b` (Levenshtein).
int edit_distance(const std::string& a, const std::string& b);

template <class Range>
std::string closest_word(const std::string& word, const Range& candidates) {
    int best = static_cast<int>(word.size()) / 3;
    best = (best < 2 ? 2 : best) + 1;
    std::string closest;
    for (const std::string& candidate : candidates) {
        const int distance = edit_distance(word, candidate);
        if (distance < best) {
            best = distance;
            closest = candidate;
        }
    }
    return closest;
}

}  // namespace pelletlab
