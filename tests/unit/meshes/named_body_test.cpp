#include "meshes/named_body.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/error.hpp"
#include "meshes/check.hpp"
#include "meshes/mass_properties.hpp"
#include "meshes/pellet_makers.hpp"

namespace pelletlab::meshes {
namespace {

double volume_of(const std::string& text) {
    return mass_properties(make_named_body(text), 1.0).volume;
}

TEST(NamedBody, EveryExampleIsAClosedBodyAndEqualsItsDefaults) {
    for (const NamedBody& body : named_bodies()) {
        const TriangleMesh mesh = make_named_body(body.example);
        EXPECT_TRUE(check(mesh).is_closed_body()) << body.example;
        EXPECT_EQ(mesh.vertices, make_named_body(body.name).vertices) << body.name;
    }
}

TEST(NamedBody, VolumesAreThoseOfTheTrueBodies) {
    // To rounding: radii are scaled so that the mesh has the volume of the true body.
    EXPECT_NEAR(volume_of("cylinder") / (std::numbers::pi * 0.25 * 3.12e-3 * 3.12e-3 * 2.96e-3), 1.0, 1e-9);
    EXPECT_NEAR(volume_of("cylinder: rim_radius = 0.3 mm") / exact_volume(RoundedCylinder{3.12e-3, 2.96e-3, 0.3e-3}), 1.0, 1e-9);
    EXPECT_NEAR(volume_of("cylinder:bevel=0.3mm") / exact_volume(BevelledCylinder{3.12e-3, 2.96e-3, 0.3e-3, 0.3e-3}), 1.0, 1e-9);
    EXPECT_NEAR(volume_of("cylinder:dome_height=0.3mm,height=2mm") / exact_volume(DomedCylinder{3.12e-3, 1.4e-3, 0.3e-3}), 1.0, 1e-9);
    EXPECT_NEAR(volume_of("sphere:diameter=2mm") / (std::numbers::pi / 6.0 * 8e-9), 1.0, 1e-9);
    EXPECT_NEAR(volume_of("box:x=1cm,y=2mm,z=300um") / (1e-2 * 2e-3 * 3e-4), 1.0, 1e-9);
    EXPECT_NEAR(volume_of("trilobe:height=6mm") / volume_of("trilobe:height=3mm"), 2.0, 1e-9);
    EXPECT_NEAR(volume_of("cylinder:rim_radius=0mm") / volume_of("cylinder"), 1.0, 1e-12);
}

TEST(NamedBody, FacetsChangeTheMeshAndNotTheVolume) {
    EXPECT_LT(make_named_body("cylinder:facets=16").faces.size(), make_named_body("cylinder").faces.size());
    EXPECT_NEAR(volume_of("cylinder:facets=16") / volume_of("cylinder"), 1.0, 1e-9);
}

TEST(NamedBody, MistakesAreErrorsThatHelp) {
    const auto message = [](const std::string& text) -> std::string {
        try {
            make_named_body(text);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::bad_input);
            return error.what();
        }
        return "no error";
    };
    EXPECT_NE(message("cilinder").find("cylinder"), std::string::npos);
    EXPECT_NE(message("cylinder:diametre=3mm").find("'diameter'"), std::string::npos);
    EXPECT_NE(message("cylinder:diameter=3").find("unit"), std::string::npos);
    EXPECT_NE(message("cylinder:diameter").find("key=value"), std::string::npos);
    EXPECT_NE(message("cylinder:diameter=3mm,diameter=4mm").find("twice"), std::string::npos);
    EXPECT_NE(message("cylinder:rim_radius=0.1mm,bevel=0.1mm").find("one kind of rim"), std::string::npos);
    for (const char* text : {"", ":", "cylinder:diameter=-3mm", "cylinder:diameter=0mm", "cylinder:rim_radius=2mm", "cylinder:facets=3", "cylinder:facets=1e9",
                             "cylinder:facets=-20", "sphere:diameter=0mm", "box:x=0mm", "ring:inner_diameter=6mm", "trilobe:lobe_offset=9mm",
                             "cylinder:dome_height=2mm", "cylinder:diameter=nanmm", "cylinder:,"})
        EXPECT_NE(message(text), "no error") << text;
}

}  // namespace
}  // namespace pelletlab::meshes
