// Every method id of a result must be explained in docs/observables.md.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core/observables.hpp"

namespace pelletlab {

inline void expect_documented(const Observables& observables) {
    std::ifstream file(PELLETLAB_SOURCE_DIR "/docs/observables.md");
    std::stringstream text;
    text << file.rdbuf();
    const std::string page = text.str();
    ASSERT_FALSE(page.empty());
    const auto expect = [&page](const std::string& name, const std::string& method) {
        EXPECT_NE(page.find("`" + method + "`"), std::string::npos) << "the method «" << method << "» of " << name << " is not in docs/observables.md";
    };
    for (const Observable& o : observables.values) expect(o.name, o.method);
    for (const Profile& profile : observables.profiles) expect(profile.name, profile.method);
    for (const FieldMap& map : observables.maps) expect(map.name, map.method);
}

}  // namespace pelletlab
