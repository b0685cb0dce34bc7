// The shipped meshes are what their makers make, to the byte.
#include "meshes/assets.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "meshes/check.hpp"
#include "meshes/mass_properties.hpp"
#include "meshes/read_mesh.hpp"
#include "support.hpp"

namespace pelletlab::meshes {
namespace {

const std::filesystem::path assets = std::filesystem::path(PELLETLAB_SOURCE_DIR) / "meshes" / "assets";

std::string content(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    EXPECT_TRUE(stream) << file;
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

TEST(Assets, FilesAreTheirMakersBytes) {
    for (const Asset& asset : make_assets()) {
        const std::string stored = content(assets / asset.file);
        EXPECT_LT(stored.size(), 300000U) << asset.file;
        EXPECT_TRUE(stored == stl_bytes(asset.mesh, asset.unit)) << asset.file << " differs from what " << asset.origin << " makes";
    }
}

TEST(Assets, ManifestIsCurrent) {
    EXPECT_EQ(content(assets / "MANIFEST.toml"), asset_manifest(make_assets()));
}

TEST(Assets, AreClosedBodiesOfTheExactVolume) {
    for (const Asset& asset : make_assets()) {
        const CheckedMesh checked = require_closed_body(read_mesh(assets / asset.file, asset.unit));
        EXPECT_TRUE(checked.before.is_closed_body()) << checked.before.summary();
        EXPECT_TRUE(checked.report.repairs.empty());
        // 32-bit coordinates: each is off by up to 6e-8, and thousands of them average out.
        EXPECT_NEAR(checked.report.volume / asset.exact_volume, 1.0, 1e-6) << asset.file;
    }
}

TEST(Assets, AreWrittenTogetherWithTheManifest) {
    const test::TemporaryFolder folder;
    write_assets(folder.path());
    for (const Asset& asset : make_assets()) EXPECT_TRUE(content(folder.path() / asset.file) == content(assets / asset.file));
    EXPECT_EQ(content(folder.path() / "MANIFEST.toml"), content(assets / "MANIFEST.toml"));
    test::refusal([&] { write_assets(folder.path() / "missing"); });
}

}  // namespace
}  // namespace pelletlab::meshes
