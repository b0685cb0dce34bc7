// Files: what is read is what was written, in every format; what is wrong is said with file and line.
#include "meshes/read_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include "meshes/check.hpp"
#include "meshes/makers.hpp"
#include "support.hpp"

namespace pelletlab::meshes {
namespace {

class ReadMesh : public testing::Test {
protected:
    std::filesystem::path file(const std::string& name, const std::string& content) const {
        std::ofstream(folder_.path() / name, std::ios::binary) << content;
        return folder_.path() / name;
    }
    std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
    std::string refusal(const std::string& name, const std::string& content, const std::string& unit = "mm") const {
        const std::filesystem::path written = file(name, content);
        return test::refusal([&] { read_mesh(written, unit); });
    }

private:
    test::TemporaryFolder folder_;
};

bool mentions(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

std::string ascii_stl(const TriangleMesh& mesh, double unit) {
    std::ostringstream text;
    text.precision(9);
    text << "solid test\n";
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        text << " facet normal 0 0 0\n  outer loop\n";
        for (int k = 0; k < 3; ++k)
            text << "   vertex " << mesh.corner(f, k).x() / unit << ' ' << mesh.corner(f, k).y() / unit << ' ' << mesh.corner(f, k).z() / unit << '\n';
        text << "  endloop\n endfacet\n";
    }
    text << "endsolid test\n";
    return text.str();
}

void expect_same(const TriangleMesh& read, const TriangleMesh& made) {
    ASSERT_EQ(read.faces.size(), made.faces.size());
    EXPECT_EQ(read.vertices.size(), made.vertices.size());
    for (std::size_t f = 0; f < made.faces.size(); ++f)
        for (int k = 0; k < 3; ++k) ASSERT_LT((read.corner(f, k) - made.corner(f, k)).norm(), 3e-7 * made.corner(f, k).norm() + 1e-18);  // 32-bit coordinates
}

TEST_F(ReadMesh, BinaryStlRoundTrip) {
    const TriangleMesh made = make_cylinder(3.12e-3, 2.96e-3, 24);
    for (const char* unit : {"mm", "m", "um", "cm"}) {
        write_stl(made, path("a.stl"), unit);
        EXPECT_EQ(std::filesystem::file_size(path("a.stl")), 84 + 50 * made.faces.size());
        const TriangleMesh read = read_mesh(path("a.stl"), unit);
        expect_same(read, made);
        EXPECT_TRUE(check(read).is_closed_body());
    }
    EXPECT_FALSE(std::filesystem::exists(path("a.stl.part")));
}

TEST_F(ReadMesh, BinaryStlWhoseHeaderSaysSolid) {
    std::string bytes = stl_bytes(make_cylinder(3e-3, 3e-3, 12), "mm");
    std::memcpy(bytes.data(), "solid exported by a CAD program", 31);
    expect_same(read_mesh(file("a.stl", bytes), "mm"), make_cylinder(3e-3, 3e-3, 12));
}

TEST_F(ReadMesh, AsciiStl) {
    const TriangleMesh made = make_cylinder(3.12e-3, 2.96e-3, 24);
    expect_same(read_mesh(file("a.STL", ascii_stl(made, 1e-3)), "mm"), made);
    // Two solids in one file, Windows line ends.
    std::string two = ascii_stl(make_box({0, 0, 0}, {1e-3, 1e-3, 1e-3}), 1e-3) + ascii_stl(make_box({2e-3, 0, 0}, {3e-3, 1e-3, 1e-3}), 1e-3);
    EXPECT_EQ(read_mesh(file("two.stl", two), "mm").faces.size(), 24U);
    std::string windows;
    for (const char c : two) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_EQ(read_mesh(file("windows.stl", windows), "mm").faces.size(), 24U);
}

TEST_F(ReadMesh, ObjWithPolygonsIsCutIntoTriangles) {
    const std::string cube =
        "# a cube of quads\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    const TriangleMesh mesh = read_mesh(file("cube.obj", cube), "cm");
    EXPECT_EQ(mesh.faces.size(), 12U);
    EXPECT_EQ(mesh.vertices.size(), 8U);
    EXPECT_TRUE(check(mesh).is_closed_body()) << check(mesh).summary();
    EXPECT_NEAR(check(mesh).volume, 1e-6, 1e-18);
}

TEST_F(ReadMesh, ObjIndicesCountFromBothEndsAndLinesGoOn) {
    const std::string text =
        "mtllib none.mtl\no part\nv 0 0 0 1.0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\nusemtl steel\ns 1\nf 1/1/1 \\\n 2/1/1 3//1 # a remark\n"
        "v 0 0 1\nf -1 -2 -4\nl 1 2\np 1\n";
    const TriangleMesh mesh = read_mesh(file("a.obj", text), "m");
    ASSERT_EQ(mesh.faces.size(), 2U);
    EXPECT_EQ(mesh.corner(1, 0), Vec3(0, 0, 1));
    EXPECT_EQ(mesh.corner(1, 1), Vec3(0, 1, 0));
    EXPECT_EQ(mesh.corner(1, 2), Vec3(0, 0, 0));
}

TEST_F(ReadMesh, ConcavePolygonKeepsItsShape) {
    // An L of six corners: a fan about its first corner would leave it.
    const TriangleMesh mesh = read_mesh(file("l.obj", "v 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nv 2 0 0\nf 1 2 3 4 5 6\n"), "m");
    ASSERT_EQ(mesh.faces.size(), 4U);
    double area = 0.0;
    for (std::size_t f = 0; f < 4; ++f) {
        const Vec3 normal = (mesh.corner(f, 1) - mesh.corner(f, 0)).cross(mesh.corner(f, 2) - mesh.corner(f, 0));
        EXPECT_GE(normal.z(), 0.0);
        area += 0.5 * normal.z();
    }
    EXPECT_NEAR(area, 3.0, 1e-12);
}

TEST_F(ReadMesh, PlyAsciiAndBinary) {
    const TriangleMesh made = make_sphere(2e-3, 1);
    std::ostringstream header, body, binary;
    header << "element vertex " << made.vertices.size() << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << made.faces.size()
           << "\nproperty list uchar int vertex_indices\nend_header\n";
    body.precision(9);
    for (const Vec3& v : made.vertices) body << v.x() * 1e3 << ' ' << v.y() * 1e3 << ' ' << v.z() * 1e3 << '\n';
    for (const Triangle& t : made.faces) body << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
    for (const Vec3& v : made.vertices)
        for (int k = 0; k < 3; ++k) {
            const auto x = static_cast<float>(v[k] * 1e3);
            binary.write(reinterpret_cast<const char*>(&x), 4);
        }
    for (const Triangle& t : made.faces) {
        binary.put(3);
        binary.write(reinterpret_cast<const char*>(t.data()), 12);
    }
    expect_same(read_mesh(file("a.ply", "ply\nformat ascii 1.0\n" + header.str() + body.str()), "mm"), made);
    std::string swapped;  // every number of four bytes the other way round
    for (std::size_t at = 0; at < binary.str().size();) {
        const bool is_length = at >= 12 * made.vertices.size() && (at - 12 * made.vertices.size()) % 13 == 0;
        std::string number = binary.str().substr(at, is_length ? 1 : 4);
        std::reverse(number.begin(), number.end());
        swapped += number;
        at += number.size();
    }
    expect_same(read_mesh(file("c.ply", "ply\nformat binary_big_endian 1.0\n" + header.str() + swapped), "mm"), made);
    expect_same(read_mesh(file("b.ply", "ply\nformat binary_little_endian 1.0\n" + header.str() + binary.str()), "mm"), made);
}

TEST_F(ReadMesh, UnitIsAskedFor) {
    write_stl(make_box({0, 0, 0}, {1e-3, 1e-3, 1e-3}), path("a.stl"), "mm");
    EXPECT_TRUE(mentions(test::refusal([&] { read_mesh(path("a.stl"), ""); }), "unit"));
    EXPECT_TRUE(mentions(test::refusal([&] { read_mesh(path("a.stl"), "mmm"); }), "mm"));
    test::refusal([&] { read_mesh(path("a.stl"), "kg"); });
}

TEST_F(ReadMesh, MissingUnreadableAndForeignFiles) {
    EXPECT_TRUE(mentions(test::refusal([&] { read_mesh(path("none.stl"), "mm"); }), "does not exist"));
    std::filesystem::create_directory(path("folder.stl"));
    EXPECT_TRUE(mentions(test::refusal([&] { read_mesh(path("folder.stl"), "mm"); }), "folder"));
    EXPECT_TRUE(mentions(refusal("empty.stl", ""), "empty"));
    EXPECT_TRUE(mentions(refusal("a.txt", "hello"), "STL, OBJ or PLY"));
    EXPECT_TRUE(mentions(refusal("a.stl", "<html><body>not found</body></html>"), "not an STL"));
    EXPECT_TRUE(mentions(refusal("b.stl", std::string(1000, '\x80')), "not an STL"));
    EXPECT_TRUE(mentions(refusal("a.obj", "just some text\nthat is no mesh\n"), "no triangles"));
    EXPECT_TRUE(mentions(refusal("a.ply", "PNG and so on"), "not a PLY"));
    if (geteuid() != 0) {
        const auto locked = file("locked.stl", "solid\n");
        std::filesystem::permissions(locked, std::filesystem::perms::none);
        EXPECT_TRUE(mentions(test::refusal([&] { read_mesh(locked, "mm"); }), "cannot be read"));
    }
}

TEST_F(ReadMesh, DamagedFilesDropNothingSilently) {
    const TriangleMesh box = make_box({0, 0, 0}, {1e-3, 1e-3, 1e-3});
    const std::string binary = stl_bytes(box, "mm"), ascii = ascii_stl(box, 1e-3);
    EXPECT_TRUE(mentions(refusal("short.stl", binary.substr(0, binary.size() - 30)), "12 triangles"));
    EXPECT_TRUE(mentions(refusal("long.stl", binary + "more"), "12 triangles"));
    const std::string cut = refusal("cut.stl", ascii.substr(0, ascii.size() / 2));
    EXPECT_TRUE(mentions(cut, "cut short")) << cut;
    const std::string damaged = "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid x\n";
    EXPECT_TRUE(mentions(refusal("two.stl", damaged), "two.stl:7")) << refusal("two.stl", damaged);
    EXPECT_TRUE(mentions(refusal("odd.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0\n"), "odd.stl:4"));
    EXPECT_TRUE(mentions(refusal("none.stl", "solid nothing\nendsolid nothing\n"), "no triangles"));
    EXPECT_TRUE(mentions(refusal("a.ply", "ply\nformat ascii 1.0\nelement vertex 99999999999\nend_header\n"), "99999999999"));
    EXPECT_TRUE(mentions(refusal("b.ply", "ply\nformat ascii 1.0\nelement vertex 3\n"), "end_header"));
    EXPECT_TRUE(mentions(refusal("bad_index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), "bad_index.obj:4"));
    EXPECT_TRUE(mentions(refusal("two_corners.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2\n"), "two_corners.obj:5"));
    EXPECT_TRUE(mentions(refusal("zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"), "«0» names no vertex"));
    refusal("words.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1endfacet/1/1 2/1/1 3//1 -1\n");  // made the library behind write out of bounds
    const std::string vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_TRUE(mentions(refusal("c.ply", "ply\nformat ascii 1.0\n" + vertices + faces + "3 0 1 7\n"), "vertex 7"));
    EXPECT_TRUE(mentions(refusal("d.ply", "ply\nformat ascii 1.0\n" + vertices + faces + "3 0 1\n"), "cut short"));
    EXPECT_TRUE(mentions(refusal("e.ply", "ply\nformat ascii 1.0\n" + vertices + faces + "2 0 1\n"), "fewer than three corners"));
    EXPECT_TRUE(mentions(refusal("f.ply", "ply\nformat ascii 1.0\n" + vertices + faces + "3 0 1 -2\n"), "f.ply:13"));
    EXPECT_TRUE(mentions(refusal("g.ply", "ply\nformat binary_little_endian 1.0\n" + vertices + faces), "g.ply"));
    EXPECT_EQ(read_mesh(file("h.ply", "ply\nformat ascii 1.0\ncomment made by hand\n" + vertices + faces + "3 0 1 2\n"), "mm").faces.size(), 1U);
}

TEST_F(ReadMesh, NumbersThatAreNotFiniteAreRefusedWithTheirLine) {
    const std::string start = "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n", end = "endloop\nendfacet\nendsolid x\n";
    EXPECT_TRUE(mentions(refusal("a.stl", start + "vertex nan 1 0\n" + end), "a.stl:6"));
    EXPECT_TRUE(mentions(refusal("b.stl", start + "vertex 0 1e60 0\n" + end), "b.stl:6"));
    EXPECT_TRUE(mentions(refusal("a.obj", "v 0 0 0\nv 1 0 inf\nv 0 1 0\nf 1 2 3\n"), "a.obj:2"));
    std::string bytes = stl_bytes(make_box({0, 0, 0}, {1e-3, 1e-3, 1e-3}), "mm");
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(bytes.data() + 84 + 2 * 50 + 12 + 12, &nan, 4);
    const std::string words = refusal("c.stl", bytes);
    EXPECT_TRUE(mentions(words, "corner 2 of triangle 3")) << words;
}

TEST_F(ReadMesh, WritingRefusesWhatItCannot) {
    const TriangleMesh box = make_box({0, 0, 0}, {1e-3, 1e-3, 1e-3});
    test::refusal([&] { write_stl(box, path("no/such/folder.stl"), "mm"); });
    test::refusal([&] { write_stl(box, path("a.stl"), "kg"); });
    test::refusal([&] { write_stl(make_box({0, 0, 0}, {1e36, 1e36, 1e36}), path("a.stl"), "um"); });
    EXPECT_FALSE(std::filesystem::exists(path("a.stl")));
}

}  // namespace
}  // namespace pelletlab::meshes
