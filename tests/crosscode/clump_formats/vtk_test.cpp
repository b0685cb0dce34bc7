// VTK itself reads the exported file and writes it again; we read that.
#include <gtest/gtest.h>

#include "program.hpp"

namespace pelletlab::crosscode {
namespace {

constexpr const char* script = R"(import sys
try:
    from vtkmodules.vtkIOLegacy import vtkPolyDataReader, vtkPolyDataWriter
except ImportError:
    sys.exit(77)
reader = vtkPolyDataReader()
reader.SetFileName('unlike.vtk')
reader.Update()
data = reader.GetOutput()
assert data.GetNumberOfPoints() == 24 and data.GetNumberOfVerts() == 24
assert data.GetPointData().GetScalars().GetName() == 'radius'
assert data.GetFieldData().GetArray('principal_inertia_kg_m2').GetNumberOfComponents() == 3
writer = vtkPolyDataWriter()
writer.SetInputData(data)
writer.SetFileName('again.vtk')
writer.SetFileTypeToASCII()
writer.Write()
)";

TEST(Vtk, ReadsAndWritesThePelletWeExported) {
    const std::string python = "/usr/bin/python3";
    if (!std::filesystem::exists(python)) GTEST_SKIP() << "no " << python;
    const Folder folder;
    const ClumpTemplate clump = unlike_pellet();
    folder.write(shapegen::formats::find("vtk").write(clump, {}));
    folder.write("run.py", script);
    const int status = folder.run(python + " run.py");
    if (status == 77) GTEST_SKIP() << "VTK for Python is not installed (Debian package python3-vtk9)";
    ASSERT_EQ(status, 0) << folder.read("output.txt");
    const shapegen::formats::ImportedClump again = shapegen::formats::find("vtk").read({{"again.vtk", folder.read("again.vtk")}}, {});
    ASSERT_EQ(again.spheres.size(), 24U);
    // VTK writes eleven digits.
    for (std::size_t i = 0; i < 24; ++i) {
        EXPECT_LT((again.spheres[i].centre - clump.rigid.spheres[i].centre).norm(), 1e-10 * clump.rigid.bounding_radius);
        EXPECT_NEAR(again.spheres[i].radius, clump.rigid.spheres[i].radius, 1e-10 * clump.rigid.bounding_radius);
    }
    EXPECT_NEAR(*again.mass / clump.rigid.mass_properties.mass, 1.0, 1e-10);
}

}  // namespace
}  // namespace pelletlab::crosscode
