#include "io/files.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "tests/unit/io/support.hpp"

using namespace pelletlab;
using pelletlab::test::error_of;
using testing::HasSubstr;

TEST(Files, TextComesBackByteForByte) {
    const test::TemporaryFolder folder;
    std::string text = "π\r\n\0end";
    text.push_back('\0');
    for (int i = 0; i < 200000; ++i) text.push_back(static_cast<char>(i * 7));  // more than one piece of the reader
    io::write_text(folder / "a.txt", text);
    EXPECT_EQ(io::read_text(folder / "a.txt"), text);
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(Files, FailureLeavesTheOldFileAndNoTemporary) {
    const test::TemporaryFolder folder;
    io::write_text(folder / "a.txt", "old");
    const auto fail_half_way = [](const std::filesystem::path& temporary) {
        test::put(temporary, "half of the new te");
        throw std::runtime_error("the disk is full");
    };
    EXPECT_THROW(io::write_atomically(folder / "a.txt", fail_half_way), std::runtime_error);
    EXPECT_EQ(io::read_text(folder / "a.txt"), "old");
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(Files, OldFileIsReplacedOnlyAtTheEnd) {
    const test::TemporaryFolder folder;
    io::write_text(folder / "a.txt", "old");
    io::write_atomically(folder / "a.txt", [&](const std::filesystem::path& temporary) {
        test::put(temporary, "new");
        EXPECT_EQ(io::read_text(folder / "a.txt"), "old");
    });
    EXPECT_EQ(io::read_text(folder / "a.txt"), "new");
}

TEST(Files, WritingOverAFolderIsRefusedAndLeavesNothing) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder / "taken" / "inside");
    const Error error = error_of([&] { io::write_text(folder / "taken", "x"); });
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    EXPECT_EQ(error.place().file, (folder / "taken").string());
    EXPECT_TRUE(std::filesystem::is_directory(folder / "taken"));
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(Files, ReadingSaysWhatIsWrong) {
    const test::TemporaryFolder folder;
    EXPECT_THAT(error_of([&] { io::read_text(folder / "none.txt"); }).what(), HasSubstr("No such file"));
    EXPECT_THAT(error_of([&] { io::read_text(folder.path()); }).what(), HasSubstr("this is a folder"));
}

TEST(Files, OutputFolderIsMadeAndProved) {
    const test::TemporaryFolder folder;
    io::prepare_output_folder(folder / "a" / "b");
    EXPECT_TRUE(std::filesystem::is_directory(folder / "a" / "b"));
    EXPECT_TRUE(std::filesystem::is_empty(folder / "a" / "b"));
    io::prepare_output_folder(folder / "a" / "b");  // a second time is no error
}

TEST(Files, UnwritableFoldersAreRefused) {
    // Permissions do not bind the superuser, so the folders below cannot exist at all: under a regular file, and in the kernel's /proc.
    const test::TemporaryFolder folder;
    test::put(folder / "file", "x");
    for (const std::filesystem::path& impossible : {folder / "file" / "out", folder / "file", std::filesystem::path("/proc/pelletlab-out")}) {
        const Error error = error_of([&] { io::prepare_output_folder(impossible); });
        EXPECT_EQ(error.exit_code(), 3) << impossible;
        EXPECT_THAT(error.what(), HasSubstr("output folder cannot be written")) << impossible;
        EXPECT_EQ(error.place().file, impossible.string());
    }
    EXPECT_THAT(error_of([&] { io::write_text(folder / "file" / "a.txt", "x"); }).what(), HasSubstr("cannot be written"));
}

TEST(Files, Sha256IsThatOfTheStandard) {
    // FIPS 180-2, appendix B, and the empty message.
    EXPECT_EQ(io::sha256_of_text(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(io::sha256_of_text("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(io::sha256_of_text(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
    const test::TemporaryFolder folder;
    test::put(folder / "a", std::string(1000000, 'a'));  // many pieces of the reader
    EXPECT_EQ(io::sha256_of_file(folder / "a"), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}
