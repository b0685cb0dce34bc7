// What a person sees while a verb works: progress with rate and time left, tables, the names of files that were written.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/progress.hpp"

namespace pelletlab::apps {

/// Progress on standard error: one line that renews itself on a terminal, a new line every ten seconds elsewhere.
/// Copyable sink; the line is finished when the stage changes or `finish` is called.
class ProgressPrinter {
public:
    ProgressPrinter();
    ProgressSink sink();
    void finish();

private:
    void show(const Progress& progress);
    bool terminal_;
    bool line_open_ = false;
    std::string stage_;
    std::chrono::steady_clock::time_point stage_begin_;
    std::chrono::steady_clock::time_point last_shown_;
};

/// Wall time since construction, and the largest memory of the process so far.
class Stopwatch {
public:
    double seconds() const;

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};
double peak_memory_megabytes();

/// «1 min 05 s», «3.2 s»
std::string duration_text(double seconds);

/// Left column padded, right column as given.
void print_pairs(const std::vector<std::pair<std::string, std::string>>& rows);
/// First row is the head; columns aligned.
void print_table(const std::vector<std::vector<std::string>>& rows);
void print_written(const std::filesystem::path& file, const std::string& what);
void print_line(const std::string& text = {});

}  // namespace pelletlab::apps
