#include "io/paraview.hpp"

#include <gmock/gmock.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <map>
#include <numbers>

#include "io/detail/vtk_xml.hpp"
#include "io/files.hpp"
#include "tests/unit/io/support.hpp"

using namespace pelletlab;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

/// A very small XML reader: every element closed in order, attributes in quotes. Fails the test on anything else.
struct XmlElement {
    std::string name, text;
    std::map<std::string, std::string> attributes;
    std::vector<XmlElement> children;

    const XmlElement& child(const std::string& wanted) const {
        for (const XmlElement& c : children)
            if (c.name == wanted) return c;
        throw std::runtime_error("no element " + wanted + " in " + name);
    }
    const XmlElement& array(const std::string& wanted) const {
        for (const XmlElement& c : children)
            if (c.attributes.at("Name") == wanted) return c;
        throw std::runtime_error("no array " + wanted + " in " + name);
    }
};

class XmlReader {
public:
    explicit XmlReader(const std::string& text) : text_(text) {}
    XmlElement document() {
        skip_blanks();
        expect("<?xml version=\"1.0\"?>");
        skip_blanks();
        XmlElement root = element();
        skip_blanks();
        if (at_ != text_.size()) throw std::runtime_error("text after the root element");
        return root;
    }

private:
    void expect(const std::string& word) {
        if (text_.compare(at_, word.size(), word) != 0) throw std::runtime_error("expected " + word + " at byte " + std::to_string(at_));
        at_ += word.size();
    }
    void skip_blanks() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    }
    std::string name() {
        const std::size_t begin = at_;
        while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_')) ++at_;
        if (begin == at_) throw std::runtime_error("a name is missing at byte " + std::to_string(at_));
        return text_.substr(begin, at_ - begin);
    }
    XmlElement element() {
        XmlElement e;
        expect("<");
        e.name = name();
        for (skip_blanks(); text_.at(at_) != '>' && text_.at(at_) != '/'; skip_blanks()) {
            const std::string key = name();
            expect("=\"");
            const std::size_t end = text_.find('"', at_);
            e.attributes[key] = text_.substr(at_, end - at_);
            at_ = end + 1;
        }
        if (text_.at(at_) == '/') {
            expect("/>");
            return e;
        }
        expect(">");
        while (text_.compare(at_, 2, "</") != 0) {
            if (text_.at(at_) == '<')
                e.children.push_back(element());
            else
                e.text += text_.at(at_++);
        }
        expect("</" + e.name + ">");
        return e;
    }

    const std::string& text_;
    std::size_t at_ = 0;
};

std::string decoded_base64(const std::string& text) {
    static const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    for (std::size_t i = 0; i < text.size(); i += 4) {
        std::uint32_t group = 0;
        int padding = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t value = letters.find(text.at(i + k));
            padding += text.at(i + k) == '=' ? 1 : 0;
            if (value == std::string::npos && text.at(i + k) != '=') throw std::runtime_error("not base64");
            group = group << 6 | static_cast<std::uint32_t>(value == std::string::npos ? 0 : value);
        }
        for (int k = 0; k < 3 - padding; ++k) bytes += static_cast<char>(group >> (16 - 8 * k) & 255);
    }
    return bytes;
}

std::size_t base64_length(std::size_t bytes) {
    return (bytes + 2) / 3 * 4;
}

/// Numbers of an array that lies at its offset behind the «_» of the appended data, as the VTK book describes it.
template <class T>
std::vector<T> numbers_of(const XmlElement& root, const XmlElement& array) {
    const std::string& all = root.child("AppendedData").text;
    const std::string data = all.substr(all.find('_') + 1 + std::stoul(array.attributes.at("offset")));
    const auto word = [](const std::string& bytes, std::size_t i) {
        std::uint64_t value = 0;
        std::memcpy(&value, bytes.data() + 8 * i, 8);
        return value;
    };
    std::string header = decoded_base64(data.substr(0, base64_length(24)));
    const std::size_t blocks = word(header, 0), block_size = word(header, 1), last_size = word(header, 2);
    header = decoded_base64(data.substr(0, base64_length(24 + 8 * blocks)));
    std::size_t packed_size = 0;
    for (std::size_t i = 0; i < blocks; ++i) packed_size += word(header, 3 + i);
    const std::string packed = decoded_base64(data.substr(base64_length(24 + 8 * blocks), base64_length(packed_size)));
    std::string bytes;
    for (std::size_t i = 0, at = 0; i < blocks; at += word(header, 3 + i), ++i) {
        uLongf size = i + 1 == blocks && last_size > 0 ? last_size : block_size;
        std::string block(size, '\0');
        EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(block.data()), &size, reinterpret_cast<const Bytef*>(packed.data() + at),
                             static_cast<uLong>(word(header, 3 + i))),
                  Z_OK);
        EXPECT_EQ(size, block.size());
        bytes += block;
    }
    EXPECT_EQ(array.attributes.at("type"), (std::is_same_v<T, float> ? "Float32" : "Int32"));
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

XmlElement read_xml(const std::filesystem::path& file) {
    const std::string text = io::read_text(file);
    return XmlReader(text).document();
}

TriangleMesh triangle() {
    return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}};
}

/// Two bodies with a surface of one triangle, one that only has spheres, and a wall that turns.
Trajectory small_trajectory(std::size_t frames) {
    Trajectory t;
    PelletShape with_surface, bare;
    with_surface.rigid.spheres = {{Vec3(0.5, 0, 0), 0.25}, {Vec3(-0.5, 0, 0), 0.125}};
    with_surface.surface_body = triangle();
    bare.rigid.spheres = {{Vec3::Zero(), 2.0}};
    bare.rigid.bounding_radius = 2.0;
    t.head.shapes = {with_surface, bare};
    t.head.shape_of_body = {0, 1, 0};
    t.head.walls = {{"shell & <\"floor\">", triangle()}};
    for (std::size_t k = 0; k < frames; ++k) {
        const Quat quarter(Eigen::AngleAxisd(std::numbers::pi / 2.0, Vec3::UnitZ()));
        Frame frame;
        frame.time = 0.1 * static_cast<double>(k);
        frame.positions = {{10, 0, 0}, {20, 0, 0}, {30, 0, 0}};
        frame.orientations = {Quat::Identity(), Quat::Identity(), quarter};
        frame.velocities = {{0, 0, 0}, {3, 4, 0}, {0, 0, -2}};
        frame.spins.assign(3, Vec3::Zero());
        frame.wall_poses = {{{0, 0, static_cast<double>(k)}, Quat::Identity()}};
        t.frames.push_back(frame);
    }
    return t;
}

}  // namespace

TEST(Paraview, BodiesArePointsWithTheirPose) {
    const test::TemporaryFolder folder;
    const io::ParaviewFiles files = io::write_paraview(small_trajectory(1), folder.path());
    EXPECT_EQ(files.bodies, folder / "bodies.pvd");
    const XmlElement root = read_xml(folder / "bodies/000000.vtp");
    EXPECT_EQ(root.attributes.at("type"), "PolyData");
    EXPECT_EQ(root.attributes.at("byte_order"), "LittleEndian");
    const XmlElement& piece = root.child("PolyData").child("Piece");
    EXPECT_EQ(piece.attributes.at("NumberOfPoints"), "3");
    EXPECT_THAT(numbers_of<float>(root, piece.child("Points").array("Points")), ElementsAre(10, 0, 0, 20, 0, 0, 30, 0, 0));
    const auto quaternion = numbers_of<float>(root, piece.child("PointData").array("quaternion"));
    ASSERT_EQ(quaternion.size(), 12u);
    const float half = std::sqrt(0.5f);  // body 2 is turned by 90° about z: w = z = cos 45°
    const float expected[] = {1, 0, 0, 0, 1, 0, 0, 0, half, 0, 0, half};
    for (std::size_t i = 0; i < quaternion.size(); ++i) EXPECT_NEAR(quaternion[i], expected[i], 1e-6) << i;  // float32
    EXPECT_THAT(numbers_of<float>(root, piece.child("PointData").array("speed")), ElementsAre(0.0f, 5.0f, 2.0f));
    EXPECT_THAT(numbers_of<std::int32_t>(root, piece.child("PointData").array("body")), ElementsAre(0, 1, 2));
}

TEST(Paraview, SurfacesOfALargeBedAreLeftOut) {
    const test::TemporaryFolder folder;
    const io::ParaviewFiles files = io::write_paraview(small_trajectory(1), folder.path(), 1, 1);  // two pellets have one triangle each
    EXPECT_TRUE(files.surface.empty());
    EXPECT_FALSE(std::filesystem::exists(folder / "surface-last.vtp"));
    EXPECT_TRUE(std::filesystem::exists(folder / "pellet-0.vtp"));
    EXPECT_EQ(io::write_paraview(small_trajectory(1), folder.path(), 1, 2).surface, folder / "surface-last.vtp");
    EXPECT_TRUE(std::filesystem::exists(folder / "surface-last.vtp"));
}

TEST(Paraview, TrueSurfacesAreThereOnceAndAtTheLastPoses) {
    const test::TemporaryFolder folder;
    io::write_paraview(small_trajectory(1), folder.path());
    EXPECT_EQ(read_xml(folder / "pellet-0.vtp").child("PolyData").child("Piece").attributes.at("NumberOfPolys"), "1");
    const XmlElement root = read_xml(folder / "surface-last.vtp");
    const XmlElement& piece = root.child("PolyData").child("Piece");
    EXPECT_EQ(piece.attributes.at("NumberOfPolys"), "2");
    const auto points = numbers_of<float>(root, piece.child("Points").array("Points"));
    // body 0 as it is, then body 2 turned by 90° about z: (1,0,0) → (0,1,0), (0,1,0) → (−1,0,0); body 1 has no surface
    ASSERT_EQ(points.size(), 18u);
    const float expected[] = {11, 0, 0, 10, 1, 0, 10, 0, 1, 30, 1, 0, 29, 0, 0, 30, 0, 1};
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(points[i], expected[i], 1e-6) << i;  // float32 of numbers up to 30
    EXPECT_THAT(numbers_of<std::int32_t>(root, piece.child("CellData").array("body")), ElementsAre(0, 2));
    EXPECT_THAT(numbers_of<float>(root, piece.child("CellData").array("speed")), ElementsAre(0.0f, 2.0f));
}

TEST(Paraview, SpheresArePointsWithRadius) {
    const test::TemporaryFolder folder;
    io::write_paraview(small_trajectory(1), folder.path());
    const XmlElement root = read_xml(folder / "spheres/000000.vtp");
    const XmlElement& piece = root.child("PolyData").child("Piece");
    EXPECT_EQ(piece.attributes.at("NumberOfPoints"), "5");
    EXPECT_THAT(numbers_of<float>(root, piece.child("PointData").array("radius")), ElementsAre(0.25f, 0.125f, 2.0f, 0.25f, 0.125f));
    EXPECT_THAT(numbers_of<std::int32_t>(root, piece.child("PointData").array("body")), ElementsAre(0, 0, 1, 2, 2));
    const auto points = numbers_of<float>(root, piece.child("Points").array("Points"));
    EXPECT_NEAR(points[9], 30.0, 1e-6);  // turned: (0.5, 0, 0) → (0, 0.5, 0)
    EXPECT_NEAR(points[10], 0.5, 1e-6);
    EXPECT_THAT(numbers_of<std::int32_t>(root, piece.child("Verts").array("offsets")), ElementsAre(5));
}

TEST(Paraview, WallsMoveAndKeepTheirNames) {
    const test::TemporaryFolder folder;
    io::write_paraview(small_trajectory(3), folder.path());
    const XmlElement root = read_xml(folder / "walls/000002.vtp");
    const XmlElement& data = root.child("PolyData");
    EXPECT_THAT(numbers_of<float>(root, data.child("Piece").child("Points").array("Points")), ElementsAre(1, 0, 2, 0, 1, 2, 0, 0, 3));
    EXPECT_THAT(numbers_of<std::int32_t>(root, data.child("Piece").child("CellData").array("wall")), ElementsAre(0));
    EXPECT_EQ(data.child("FieldData").array("TimeValue").text, "0.2");
    std::istringstream codes(data.child("FieldData").array("names").text);
    std::string name;
    for (int code = 0; codes >> code && code != 0;) name += static_cast<char>(code);
    EXPECT_EQ(name, "shell & <\"floor\">");
}

TEST(Paraview, PvdListsEachNthFrameAndTheLast) {
    const test::TemporaryFolder folder;
    const auto listed = [&](std::size_t frames, std::size_t every) {
        io::write_paraview(small_trajectory(frames), folder.path(), every);
        std::vector<std::string> list;
        const XmlElement root = read_xml(folder / "bodies.pvd");
        for (const XmlElement& entry : root.child("Collection").children) {
            list.push_back(entry.attributes.at("timestep") + " " + entry.attributes.at("file"));
            EXPECT_TRUE(std::filesystem::exists(folder / entry.attributes.at("file")));
        }
        return list;
    };
    EXPECT_THAT(listed(6, 2), ElementsAre("0 bodies/000000.vtp", "0.2 bodies/000002.vtp", "0.4 bodies/000004.vtp", "0.5 bodies/000005.vtp"));
    EXPECT_THAT(listed(3, 2), ElementsAre("0 bodies/000000.vtp", "0.2 bodies/000002.vtp"));
    EXPECT_THAT(listed(2, 0), ElementsAre("0 bodies/000000.vtp", "0.1 bodies/000001.vtp"));
    EXPECT_TRUE(listed(0, 1).empty());
}

TEST(Paraview, LargeArraysAreCutIntoBlocks) {
    io::detail::VtkPolyData data;
    for (int i = 0; i < 300000; ++i) data.points.push_back(static_cast<float>(i) / 7.0f);  // 1.2 MB: several blocks, the last one shorter
    const std::string text = io::detail::vtp_text(data);
    const XmlElement root = XmlReader(text).document();
    EXPECT_EQ(numbers_of<float>(root, root.child("PolyData").child("Piece").child("Points").array("Points")), data.points);
    data.points.resize(3 * 65536);  // whole blocks only
    const std::string whole = io::detail::vtp_text(data);
    const XmlElement whole_root = XmlReader(whole).document();
    EXPECT_EQ(numbers_of<float>(whole_root, whole_root.child("PolyData").child("Piece").child("Points").array("Points")), data.points);
}

TEST(Paraview, UnwritableFolderIsAnError) {
    const test::TemporaryFolder folder;
    test::put(folder / "file", "x");
    EXPECT_THAT(test::error_of([&] { io::write_paraview(small_trajectory(1), folder / "file" / "paraview"); }).what(),
                HasSubstr("output folder cannot be written"));
}
