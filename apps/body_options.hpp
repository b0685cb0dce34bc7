// The options that name a body, the same for every verb that works on one.
#pragma once

#include <CLI/App.hpp>
#include <string>

#include "apps/shape_body.hpp"

namespace pelletlab::apps {

struct BodyOptions {
    std::string mesh, unit, parametric, repair;
};

/// mesh, --unit, --body, --repair, and the list of bodies in the footer.
void add_body_options(CLI::App& verb, BodyOptions& options);

/// Error(usage) unless exactly one of mesh and --body is given.
BodyRequest body_request(const BodyOptions& options);

std::string list_of_bodies();

}  // namespace pelletlab::apps
