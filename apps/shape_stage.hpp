// Stage 1 of the chain: mesh file → clump template file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/shape_body.hpp"
#include "apps/shape_methods.hpp"
#include "core/clump_template.hpp"
#include "core/triangle_mesh.hpp"
#include "meshes/signed_distance.hpp"
#include "shapegen/make_clump.hpp"

namespace pelletlab::apps {

struct ShapeRequest {
    BodyRequest body;
    std::string method = fit_method;   ///< of shape_methods.hpp
    bool volume_matched = false;       ///< methods other than the fit: one common radius offset gives the union the body's volume
    shapegen::ClumpSettings settings;  ///< of the fit; density and mass source of every method
    std::filesystem::path output = "pellet.clump.toml";
    bool picture = true;               ///< <output without .clump.toml>.png beside it
    std::vector<std::string> against;  ///< methods whose figures are printed beside, as drawn and volume-matched
    bool force = false;                ///< make it again although nothing has changed
};

/// Reads and checks the mesh, fits, measures, writes the template and its picture, and prints what a person wants to know.
void run_shape(const ShapeRequest& request);

/// The clump file of the request: the one that is there when nothing has changed, else made and written, silently and without picture. For verbs that make
/// many; `body` is that of request.body.
struct QuietClump {
    ClumpTemplate clump;
    bool was_there = false;
};
QuietClump ensure_clump(const ShapeRequest& request, const BodyOnDisk& body, const ProgressSink& progress);

/// The clump by the method of the request: fitted, or made by another method and judged by the same code. Spheres of `fit` are in the frame of the mesh.
/// `exact`: the body's exact distance, where that is known already.
shapegen::MadeClump make_by_method(const TriangleMesh& body, const std::string& method, bool volume_matched, const shapegen::ClumpSettings& settings,
                                   const ProgressSink& progress, std::shared_ptr<const meshes::SignedDistance> exact = nullptr);

/// The output's path without .clump.toml: pictures and meshes that go with it start with that.
std::filesystem::path stem_of(const std::filesystem::path& clump_file);

/// The pellet's true surface in the body frame of its clump, from the mesh file that the clump names (relative to the clump file).
/// Throws Error(bad_input) when that file is gone or no longer the one that the clump was made from.
TriangleMesh true_surface(const ClumpTemplate& clump, const std::filesystem::path& clump_file);

}  // namespace pelletlab::apps
