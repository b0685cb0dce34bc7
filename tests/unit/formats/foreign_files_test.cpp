// Files as other people and programs write them: layouts from the programs' own examples and manuals, numbers ours.
#include <gtest/gtest.h>

#include "test_clump.hpp"

namespace pelletlab::shapegen::formats {
namespace {

TEST(Foreign, LiggghtsWithCommentsContinuationsAndWindowsLineEnds) {
    const ImportedClump clump = find("liggghts").read({{"c.txt", "# a comment\r\n\r\n0. 0. 0. 0.5 # first\r\n1.0E0 +.25 &\r\n -2 .75 17\r\n"}}, {"mm", ""});
    ASSERT_EQ(clump.spheres.size(), 2U);
    EXPECT_EQ(clump.spheres[1].centre, Vec3(0.001, 0.00025, -0.002));
    EXPECT_EQ(clump.spheres[1].radius, 0.00075);
    EXPECT_FALSE(clump.mass.has_value());
}

TEST(Foreign, LiggghtsScriptGivesScaleMassAndInertia) {
    const char* script =
        "units si\nfix pts1 all particletemplate/multisphere 15485863 atom_type 1 density constant 1800 nspheres 2 ntry 100000 &\n"
        "  spheres file clump.txt scale 0.001 type 1 mass 4.0e-05 inertia_tensor 5e-11 1e-12 2e-12 6e-11 3e-12 7e-11 use_density\n";
    const ImportedClump clump = find("liggghts").read({{"clump.txt", "0 0 0 1\n0 0 1 1\n"}, {"in.tube", script}}, {});
    EXPECT_EQ(clump.spheres[1].centre.z(), 0.001);
    EXPECT_EQ(clump.mass, 4e-5);
    EXPECT_NEAR(*clump.volume, 4e-5 / 1800.0, 1e-22);
    EXPECT_EQ(*clump.inertia, (Mat3{{5e-11, 1e-12, 2e-12}, {1e-12, 6e-11, 3e-12}, {2e-12, 3e-12, 7e-11}}));  // order xx xy xz yy yz zz
}

TEST(Foreign, LiggghtsScriptWithoutMassIsSaidSo) {
    const ImportedClump clump =
        find("liggghts")
            .read(
                {{"c", "0 0 0 1\n0 0 1 1\n"},
                 {"s", "fix p all particletemplate/multisphere 1 atom_type 1 density constant 2500 nspheres 2 ntry 1000000 spheres file c scale 1e-3 type 1"}},
                {});
    EXPECT_FALSE(clump.mass.has_value());
    EXPECT_EQ(clump.density, 2500.0);
    ASSERT_EQ(clump.notes.size(), 1U);
}

TEST(Foreign, LammpsWithoutHeaderSumsTheAtoms) {
    const char* text =
        "comment\n\n2 atoms\n0 bonds\n\nCoords\n\n2 1 0 0 # out of order\n1 -1 0 0\n\nTypes\n\n1 1\n2 1\n\nDiameters\n\n1 2\n2 2\n\nMasses\n\n1 3\n2 3\n";
    const ImportedClump clump = find("lammps").read({{"m", text}}, {"m", "kg"});
    EXPECT_EQ(clump.spheres[0].centre.x(), -1.0);
    EXPECT_EQ(clump.spheres[0].radius, 1.0);
    EXPECT_EQ(clump.mass, 6.0);
    // Two spheres of mass 3 and radius 1 at ±1: 2 · (2/5 · 3) = 2.4 along x, 2.4 + 2 · 3 = 8.4 across.
    EXPECT_NEAR((*clump.inertia)(0, 0), 2.4, 1e-14);
    EXPECT_NEAR((*clump.inertia)(1, 1), 8.4, 1e-14);
    EXPECT_FALSE(clump.notes.empty());
}

TEST(Foreign, LammpsInertiaInTheOrderOfTheManual) {
    const char* text = "#\n1 atoms\n1 mass\n0.1 0.2 0.3 com\n1 2 2.5 0.1 0.2 0.3 inertia\n\nCoords\n\n1 0 0 0\n\nDiameters\n\n1 1\n";
    const ImportedClump clump = find("lammps").read({{"m", text}}, {"m", "kg"});
    EXPECT_EQ(*clump.inertia, (Mat3{{1, 0.1, 0.2}, {0.1, 2, 0.3}, {0.2, 0.3, 2.5}}));
    EXPECT_EQ(*clump.centre_of_mass, Vec3(0.1, 0.2, 0.3));
}

TEST(Foreign, YadeTextClumpsAndMaterials) {
    EXPECT_EQ(find("yade").read({{"f", "#format x_y_z_r_clumpId\n0 0 0 1 12\n0 0 1 2 12\n"}}, {"m", ""}).spheres.size(), 2U);
    EXPECT_EQ(find("yade").read({{"f", "#format id_x_y_z_r_matId\n5 0 0 3 2 0\n"}}, {"m", ""}).spheres[0].centre.z(), 3.0);
    EXPECT_EQ(find("yade").read({{"f", "0 0 3 2\n"}}, {"m", ""}).spheres[0].radius, 2.0);
}

TEST(Foreign, MercuryAsNumpySavesIt) {
    const std::vector<FormatFile> files{
        {"C/Clump/Clump.txt", "-9.243435745237121637e+00,-1.076676609131506923e-01,-1.059671576086537614e+00,4.601244999999999585e+00\n"},
        {"C/Inertia/PD.txt", "1.0e+00,0.0e+00,0.0e+00\n0,1,0\n0,0,1\n"},
        {"C/Inertia/Mass.txt", "2.5e+03\n"},
        {"C/Inertia/TOI.txt", "2e+05,2.682507280723080090e+00,-1.5e+03\n2.682507280723376741e+00,3e+05,-4e+02\n-1.5e+03,-4e+02,4e+05\n"}};
    const ImportedClump clump = find("mercury").read(files, {"m", "kg"});
    EXPECT_EQ(clump.spheres[0].centre.x(), -9.243435745237121637);
    EXPECT_EQ(clump.mass, 2500.0);
    EXPECT_NEAR((*clump.inertia)(0, 1), 2.68250728072322, 1e-12);
    EXPECT_EQ((*clump.inertia)(1, 2), -400.0);
}

TEST(Foreign, ChronoWithTrailingCommentsAndExtraColumns) {
    const ImportedClump clump = find("chrono").read({{"t.csv", "name,r,x,y,z\na,0.8,0.00,-0.41,0\nb,0.8,-0.33,0.19,0\n# volume = 4.2520508\n"}}, {"m", ""});
    ASSERT_EQ(clump.spheres.size(), 2U);
    EXPECT_EQ(clump.spheres[0].centre, Vec3(0.0, -0.41, 0.0));
}

TEST(Foreign, PfcExampleOfTheManualWithCalculatedInertia) {
    const char* text =
        "model new\nmodel domain extent -5 5\nclump template create name 'three_peb' calculate ...\n"
        "  pebbles 3 0.25 (-0.55,0.0,0.6) ... ; first\n  0.25 (-0.75,0.0,0.15) &\n 0.25 -0.75 0.0 0.4\nclump replicate name 'three_peb' id 1\n";
    const ImportedClump clump = find("pfc").read({{"r.dat", text}}, {"m", ""});
    ASSERT_EQ(clump.spheres.size(), 3U);
    EXPECT_EQ(clump.name, "three_peb");
    EXPECT_EQ(clump.spheres[2].centre, Vec3(-0.75, 0.0, 0.4));
    EXPECT_FALSE(clump.volume.has_value());
    EXPECT_FALSE(clump.notes.empty());
}

TEST(Foreign, PfcTemplateHasUnitDensity) {
    const char* text = "CLUMP TEMPLATE CREATE name 'a' pebbles 1 1 0 0 0 volume 4 inertia 1 2 2.5 0.1 0.2 0.3 position 0.5 0 0\n";
    const ImportedClump clump = find("pfc").read({{"r.dat", text}}, {"mm", ""});
    EXPECT_NEAR(*clump.volume, 4e-9, 1e-24);
    EXPECT_FALSE(clump.mass.has_value());
    EXPECT_EQ(*clump.centre_of_mass, Vec3(0.0005, 0.0, 0.0));
    const RigidTemplate rigid = rigid_template(clump, 2500.0);
    EXPECT_NEAR(rigid.mass_properties.mass, 1e-5, 1e-20);
    EXPECT_NEAR(rigid.mass_properties.principal_inertia.sum(), 5.5 * 1e-15 * 2500.0, 1e-25);  // trace
}

TEST(Foreign, CsvOfOtherGenerators) {
    EXPECT_EQ(find("csv").read({{"f", "1.0,2.0,3.0,4.0\n"}}, {"mm", ""}).notes.size(), 1U);
    EXPECT_EQ(find("csv").read({{"f", "R;X;Y;Z\n4;1;2;3\n"}}, {"m", ""}).spheres[0].centre, Vec3(1, 2, 3));
    EXPECT_EQ(find("csv").read({{"f", "\"x [m]\",\"y [m]\",\"z [m]\",\"Diameter [m]\"\n1,2,3,4\n"}}, {}).spheres[0].radius, 2.0);
    EXPECT_EQ(find("csv").read({{"f", "1 2 3 4\n"}}, {"m", ""}).spheres[0].radius, 4.0);
}

TEST(Foreign, EdemTableInAnotherOrder) {
    const char* text = "Position X\tPosition Y\tPosition Z\tPhysical Radius\n1\t2\t3\t4\n";
    EXPECT_EQ(find("edem").read({{"f", text}}, {"mm", ""}).spheres[0].centre, Vec3(0.001, 0.002, 0.003));
}

TEST(Foreign, VtkUnstructuredGridWithOtherArrays) {
    const char* text =
        "# vtk DataFile Version 2.0\nclump\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 2 float\n0 0 0 1 0 0\nCELLS 2 4\n1 0\n1 1\nCELL_TYPES 2\n1\n1\n"
        "POINT_DATA 2\nVECTORS velocity float\n0 0 0 0 0 0\nSCALARS id int 1\nLOOKUP_TABLE default\n1 2\nFIELD FieldData 1\nRadius 1 2 float\n0.5 0.75\n";
    const ImportedClump clump = find("vtk").read({{"f.vtk", text}}, {"mm", ""});
    ASSERT_EQ(clump.spheres.size(), 2U);
    EXPECT_EQ(clump.spheres[1].radius, 0.00075);
}

TEST(Foreign, VtkVersion5WithOffsetsAndMetadata) {
    const char* text =
        "# vtk DataFile Version 5.1\nvtk output\nASCII\nDATASET POLYDATA\nPOINTS 2 double\n0 0 0 1 0 0 \n\nMETADATA\nINFORMATION 2\nNAME L2_NORM_RANGE "
        "LOCATION "
        "vtkDataArray\nDATA 2 0 1 \nNAME L2_NORM_FINITE_RANGE LOCATION vtkDataArray\nDATA 2 0 1 \n\nVERTICES 3 2\nOFFSETS vtktypeint64\n0 1 2 \nCONNECTIVITY "
        "vtktypeint64\n0 1 \nPOINT_DATA 2\nSCALARS radius double\nLOOKUP_TABLE default\n0.5 0.75 \n";
    const ImportedClump clump = find("vtk").read({{"f.vtk", text}}, {"mm", ""});
    ASSERT_EQ(clump.spheres.size(), 2U);
    EXPECT_EQ(clump.spheres[1].centre.x(), 0.001);
}

TEST(Foreign, AnInertiaNoBodyHasIsNoted) {
    const char* text = "#\n1 atoms\n1 mass\n0 0 0 com\n1 1 3 0 0 0 inertia\n\nCoords\n\n1 0 0 0\n\nDiameters\n\n1 1\n";
    EXPECT_EQ(find("lammps").read({{"m", text}}, {"m", "kg"}).notes.size(), 1U);
}

}  // namespace
}  // namespace pelletlab::shapegen::formats
