// A window of a rotating drum, summed over its end view: the whole of it, and the groups of frames that tell its errors.
#pragma once

#include <functional>
#include <vector>

#include "core/observables.hpp"
#include "observables/detail/end_view.hpp"
#include "observables/detail/free_surface.hpp"
#include "observables/drum.hpp"

namespace pelletlab::observables::detail {

/// One stretch of time: its sums, free surface and figures.
struct Stretch {
    GroupSums sums;
    FreeSurface surface;
    SurfaceFigures figures;
    double bed_area = 0.0;  ///< [m²], of the end view below the surface

    double solid_volume() const { return sums.solid_volume / static_cast<double>(sums.frames); }  ///< [m³], mean over the frames
};

struct Analysis {
    DrumGeometry drum;
    SurfaceSettings settings;  ///< drum_length: of the slab
    ChordFrame chord;
    EndView view;
    double bulk = 0.0;  ///< packing fraction of the bed's inside
    Stretch whole;
    std::vector<Stretch> groups;
    TimeWindow window;

    /// A figure of the window with the standard error from the groups; `scale`: unit in SI.
    Observable observable(const std::string& name, const char* unit, double scale, const char* method,
                          const std::function<double(const Stretch&)>& figure) const;
};

/// Frames of the trajectory whose time lies in the window. Throws Error(bad_input) when there is none.
std::vector<std::size_t> frames_in(const FrameSource& trajectory, const TimeWindow& window);

/// Up to 20 groups of neighbouring frames, as equal as can be.
std::vector<std::vector<std::size_t>> grouped(const std::vector<std::size_t>& frames);

/// Frame of the bed: from its mean centre of mass over these frames.
ChordFrame chord_frame(const Vec2& centre_of_mass, double rotation_speed);

/// Mean equivalent diameter of the bodies [m].
double mean_diameter(const TrajectoryHeader& header, const std::vector<PelletPoints>& shapes);

Analysis analyse_drum(const FrameSource& trajectory, const std::vector<std::size_t>& frames, const std::vector<PelletPoints>& shapes, const DrumGeometry& drum,
                      const ViewFilter& filter);

/// «not steady» when an angle or the bed height moved between the halves of the window by more than a tolerance and three errors, else «complete».
std::string steadiness(const Analysis& analysis);

}  // namespace pelletlab::observables::detail
