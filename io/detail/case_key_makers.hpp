// How rows of the table of case keys are written; for the files of that table only.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/detail/case_keys.hpp"

namespace pelletlab::io::detail {

inline std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> segments(1);
    for (const char c : text) {
        if (c == '.')
            segments.emplace_back();
        else
            segments.back() += c;
    }
    return segments;
}

template <class T>
CaseValue to_value(const T& member) {
    if constexpr (std::is_same_v<T, Rig>)
        return rig_name(member);
    else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>)
        return static_cast<std::uint64_t>(member);
    else
        return member;
}

template <class T>
void from_value(T& member, const CaseValue& value) {
    if constexpr (std::is_same_v<T, Rig>) {
        for (const Rig rig : all_rigs)
            if (rig_name(rig) == std::get<std::string>(value)) member = rig;
    } else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>)
        member = static_cast<T>(std::get<std::uint64_t>(value));
    else
        member = std::get<T>(value);
}

template <class T>
constexpr KeyKind kind_of() {
    if constexpr (std::is_same_v<T, double>) return KeyKind::number;
    if constexpr (std::is_same_v<T, bool>) return KeyKind::flag;
    if constexpr (std::is_same_v<T, std::string>) return KeyKind::text;
    if constexpr (std::is_same_v<T, Vec3>) return KeyKind::vector3d;
    if constexpr (std::is_same_v<T, Rig>) return KeyKind::choice;
    return KeyKind::whole;
}

/// `member(case, name)` is the place of the value in the case, const or not.
template <class Member>
CaseKey key(const char* path, Member member, const char* doc) {
    using T = std::remove_cvref_t<decltype(member(std::declval<Case&>(), std::string()))>;
    CaseKey k;
    k.path = split(path);
    k.kind = kind_of<T>();
    k.doc = doc;
    k.get = [member](const Case& c, const std::string& name) { return to_value(member(c, name)); };
    k.set = [member](Case& c, const std::string& name, const CaseValue& value) { from_value(member(c, name), value); };
    return k;
}

inline CaseKey in(Dimension dimension, const char* unit, CaseKey k) {
    k.dimension = dimension;
    k.unit = unit;
    return k;
}

inline CaseKey within(Range range, CaseKey k) {
    k.range = range;
    return k;
}

inline CaseKey one_of(std::vector<std::string> choices, CaseKey k) {
    k.choices = std::move(choices);
    return k;
}

/// A text that must be one of these words.
inline CaseKey word(std::vector<std::string> choices, CaseKey k) {
    k.kind = KeyKind::choice;
    k.choices = std::move(choices);
    return k;
}

inline CaseKey optional(CaseKey k) {
    k.optional = true;
    return k;
}

inline constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Range above(double lower) {
    return {lower, infinity, true, true};
}
constexpr Range from(double lower) {
    return {lower, infinity, false, true};
}
constexpr Range from_to(double lower, double upper) {
    return {lower, upper, false, false};
}
constexpr Range above_to(double lower, double upper) {
    return {lower, upper, true, false};
}
constexpr Range between(double lower, double upper) {
    return {lower, upper, true, true};
}

// A key's value in a case `c`; `name` is the material or contact that «*» stands for.
#define PELLETLAB_MEMBER(expression)                \
    [](auto& c, const std::string& name) -> auto& { \
        (void)c, (void)name;                        \
        return expression;                          \
    }

}  // namespace pelletlab::io::detail
