// Lines, words and numbers of a text file, with the line at hand for messages.
#pragma once

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace pelletlab::meshes::detail {

class TextScan {
public:
    TextScan(std::string_view text, const std::filesystem::path& file, std::size_t from = 0, int line_before = 0)
        : text_(text), file_(file), position_(from), number_(line_before) {}

    /// Goes to the next line; false at the end. A backslash at the end of a line joins the next one when `joins`.
    bool next_line(bool joins = false) {
        if (position_ >= text_.size()) return false;
        joined_.clear();
        while (true) {
            const std::size_t end = std::min(text_.find('\n', position_), text_.size());
            std::string_view piece = text_.substr(position_, end - position_);
            position_ = std::min(end + 1, text_.size());
            ++number_;
            if (!piece.empty() && piece.back() == '\r') piece.remove_suffix(1);
            const bool goes_on = joins && !piece.empty() && piece.back() == '\\' && position_ < text_.size();
            if (goes_on) piece.remove_suffix(1);
            if (!goes_on && joined_.empty()) {
                rest_ = piece;
                return true;
            }
            joined_.append(piece).push_back(' ');
            if (goes_on) continue;
            rest_ = joined_;
            return true;
        }
    }

    /// Cuts the next word off the line; empty at its end.
    std::string_view word() {
        const std::size_t begin = rest_.find_first_not_of(blanks);
        if (begin == std::string_view::npos) return rest_ = {};
        const std::size_t end = std::min(rest_.find_first_of(blanks, begin), rest_.size());
        const std::string_view result = rest_.substr(begin, end - begin);
        rest_.remove_prefix(end);
        return result;
    }

    /// The next word as a coordinate; throws unless it is a number that 32 bits hold.
    double coordinate() {
        std::string_view text = word();
        if (text.empty()) throw fault("a coordinate is missing", "export the mesh again");
        const std::string shown(text.substr(0, 40));
        if (text.front() == '+') text.remove_prefix(1);
        double value = 0.0;
        const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool is_whole = end == text.data() + text.size();
        if (status == std::errc::result_out_of_range && is_whole)
            value = std::strtod(std::string(text).c_str(), nullptr);  // too small is zero, too large is found below
        else if (status != std::errc() || !is_whole)
            throw fault("«" + shown + "» is not a coordinate", "export the mesh again");
        if (!std::isfinite(static_cast<float>(value))) throw fault("the coordinate «" + shown + "» is not a finite number", "export the mesh again");
        return value;
    }

    int line() const { return number_; }
    std::size_t position() const { return position_; }
    Error fault(std::string problem, std::string remedy) const { return bad_input(std::move(problem), std::move(remedy), {file_.string(), number_}); }

private:
    static constexpr std::string_view blanks = " \t\v\f\r";
    std::string_view text_;
    const std::filesystem::path& file_;
    std::size_t position_ = 0;
    int number_ = 0;
    std::string_view rest_;
    std::string joined_;
};

inline bool equals_ignoring_case(std::string_view a, std::string_view lower) {
    return std::equal(a.begin(), a.end(), lower.begin(), lower.end(), [](char x, char y) { return std::tolower(static_cast<unsigned char>(x)) == y; });
}

}  // namespace pelletlab::meshes::detail
