// One entry of the table a format; each is defined in the file of that name.
#pragma once

#include "shapegen/formats/formats.hpp"

namespace pelletlab::shapegen::formats::detail {

Format liggghts();
Format lammps();
Format yade();
Format mercury();
Format chrono();
Format pfc();
Format edem();
Format csv();
Format vtk();
Format stl();

}  // namespace pelletlab::shapegen::formats::detail
