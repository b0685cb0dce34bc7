#include "apps/terminal.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace pelletlab::apps {

using Clock = std::chrono::steady_clock;

namespace {

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

std::string rate_text(double rate, const std::string& unit) {
    if (rate <= 0.0) return {};
    return rate >= 1e5 ? fmt::format(", {:.2g} million {}", rate * 1e-6, unit) : fmt::format(", {:.0f} {}", rate, unit);
}

/// Columns that a UTF-8 text takes: continuation bytes take none.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

std::string padded(const std::string& text, std::size_t width) {
    return text + std::string(width - std::min(width, width_of(text)), ' ');
}

}  // namespace

ProgressPrinter::ProgressPrinter() : terminal_(isatty(STDERR_FILENO) != 0), stage_begin_(Clock::now()), last_shown_(Clock::now()) {}

ProgressSink ProgressPrinter::sink() {
    return [this](const Progress& progress) { show(progress); };
}

void ProgressPrinter::show(const Progress& progress) {
    if (progress.stage != stage_) {
        finish();
        stage_ = progress.stage;
        stage_begin_ = Clock::now();
        last_shown_ = stage_begin_;
        if (!terminal_) return;
    }
    if (seconds_since(last_shown_) < (terminal_ ? 0.2 : 10.0)) return;
    last_shown_ = Clock::now();

    std::string text = fmt::format("  {}", progress.stage);
    const double elapsed = seconds_since(stage_begin_);
    if (progress.total > 0.0) {
        const double share = std::clamp(progress.done / progress.total, 0.0, 1.0);
        text += fmt::format(": {:3.0f} % ({:.3g} of {:.3g} {})", 100.0 * share, progress.done, progress.total, progress.unit);
        text += rate_text(progress.rate, progress.rate_unit);
        if (share > 0.02) text += fmt::format(", {} left", duration_text(elapsed * (1.0 - share) / share));
    } else {
        text += fmt::format(": {:.3g} {}", progress.done, progress.unit) + rate_text(progress.rate, progress.rate_unit);
    }
    if (!progress.note.empty()) text += " (" + progress.note + ")";
    if (terminal_)
        fmt::print(stderr, "\r\033[K{}", text);
    else
        fmt::print(stderr, "{}\n", text);
    std::fflush(stderr);
    line_open_ = terminal_;
}

void ProgressPrinter::finish() {
    if (line_open_) fmt::print(stderr, "\r\033[K");
    std::fflush(stderr);
    line_open_ = false;
    stage_.clear();
}

double Stopwatch::seconds() const {
    return seconds_since(begin_);
}

double peak_memory_megabytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

std::string duration_text(double seconds) {
    if (seconds < 60.0) return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<long>(std::lround(seconds));
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

void print_pairs(const std::vector<std::pair<std::string, std::string>>& rows) {
    std::size_t width = 0;
    for (const auto& [name, value] : rows) width = std::max(width, width_of(name));
    for (const auto& [name, value] : rows) fmt::print("  {}  {}\n", padded(name, width), value);
}

void print_table(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> widths;
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (i == widths.size()) widths.push_back(0);
            widths[i] = std::max(widths[i], width_of(row[i]));
        }
    for (const auto& row : rows) {
        std::string line = " ";
        for (std::size_t i = 0; i < row.size(); ++i) line += " " + padded(row[i], widths[i]) + " ";
        fmt::print("{}\n", line);
    }
}

void print_written(const std::filesystem::path& file, const std::string& what) {
    fmt::print("  wrote {}  ({})\n", file.string(), what);
}

void print_line(const std::string& text) {
    fmt::print("{}\n", text);
    std::fflush(stdout);
}

}  // namespace pelletlab::apps
