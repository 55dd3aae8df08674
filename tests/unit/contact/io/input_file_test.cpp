// Files are read whole, bounded, and from files only.
#include "pincer/contact/io/input_file.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <fstream>

#include "pincer/contact/mesh_reader.h"
#include "pincer/tests/support/error_of.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer {
namespace {

using tests::errorOf;
using tests::TemporaryDirectory;

constexpr InputKind kNote = {"a note", 1000, true, "Write less."};
constexpr InputKind kBytes = {"an image", 1000, false, "Take less."};

class InputFiles : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& content) {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  std::string problem(const std::string& path, const InputKind& kind = kNote) {
    return errorOf([&] { readInputFile(path, kind); });
  }
  static bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

  TemporaryDirectory folder_;
};

TEST_F(InputFiles, AreReadWhole) {
  EXPECT_EQ(readInputFile(write("empty", ""), kNote), "");
  const std::string whole(1000, 'x');
  EXPECT_EQ(readInputFile(write("whole", whole), kNote), whole);
  const std::string image("a\0b\xff", 4);
  EXPECT_EQ(readInputFile(write("image", image), kBytes), image);
}

TEST_F(InputFiles, AFileWithoutEndDoesNotFillMemory) {
  const std::string said = problem("/dev/zero");
  EXPECT_TRUE(holds(said, "/dev/zero: this is a device, not a file; a note is needed here.")) << said;
}

TEST_F(InputFiles, APipeOrSocketIsNotWaitedFor) {
  const std::string pipe = folder_ / "pipe", socket_path = folder_ / "s";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(holds(problem(pipe), "this is a pipe")) << problem(pipe);
  EXPECT_TRUE(holds(problem(pipe), "Save its content to a file first.")) << problem(pipe);
  EXPECT_TRUE(holds(errorOf([&] { contact::readMesh(pipe); }), "this is a pipe"));
  const int s = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  socket_path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  ASSERT_EQ(::bind(s, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  EXPECT_TRUE(holds(problem(socket_path), "this is a socket")) << problem(socket_path);
  ::close(s);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST_F(InputFiles, NamesWhatIsWrongWithThePath) {
  EXPECT_TRUE(holds(problem(folder_.path()), "this is a directory"));
  EXPECT_TRUE(holds(problem(folder_ / "none"), "there is no such file"));
  EXPECT_TRUE(holds(problem(write("f", "x") + "/g"), "there is no such file"));
  EXPECT_TRUE(holds(problem(std::string(5000, 'n')), "can't be opened"));
}

TEST_F(InputFiles, ALargeFileIsRefusedBeforeItIsRead) {
  const std::string path = write("large", "x");
  ASSERT_EQ(::truncate(path.c_str(), 1'000'000'000'000), 0);  // sparse: it takes no room, and would fill any memory
  const std::string said = problem(path, kBytes);
  EXPECT_TRUE(holds(said, "an image has at most 0.000953674 MB. Take less.")) << said;
  EXPECT_TRUE(holds(errorOf([&] { InputFile(path, kNote); }), "Write less."));
}

// Files of the kernel say that they are empty; what is counted is what comes.
TEST_F(InputFiles, AFileThatLiesAboutItsSizeIsCountedWhileItIsRead) {
  EXPECT_EQ(readInputFile("/proc/self/comm", kNote).back(), '\n');
  EXPECT_TRUE(holds(problem("/proc/self/smaps"),
                    "the file is larger than 0.000953674 MB, the most that a note has. Write less."));
}

TEST_F(InputFiles, ANulByteDoesNotEndATextInSilence) {
  const std::string path = write("nul", std::string("one\ntwo\0three", 13));
  EXPECT_TRUE(holds(problem(path), "nul:2: a NUL byte (byte 7 of the text)")) << problem(path);
  InputFile lines(path, kNote);
  std::string_view line;
  EXPECT_TRUE(lines.nextLine(line));
  EXPECT_TRUE(holds(errorOf([&] { lines.nextLine(line); }), "nul:2: a NUL byte"));
  const std::string mesh = write("m.obj", std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\n# a\0b\nf 1 2 3\n", 38));
  EXPECT_TRUE(holds(errorOf([&] { contact::readMesh(mesh); }), "m.obj:4: the line holds a NUL byte"));
}

TEST_F(InputFiles, LinesAreThoseOfTheFile) {
  InputFile file(write("lines", "a\r\n\nbc"), kNote);
  std::string_view line;
  ASSERT_TRUE(file.nextLine(line));
  EXPECT_EQ(line, "a");
  ASSERT_TRUE(file.nextLine(line));
  EXPECT_EQ(line, "");
  ASSERT_TRUE(file.nextLine(line));
  EXPECT_EQ(line, "bc");
  EXPECT_EQ(file.line(), 3);
  EXPECT_FALSE(file.nextLine(line));
}

// Lines of all lengths, so that many lie across the blocks in which a file is read.
TEST_F(InputFiles, LinesAcrossBlocksAreWhole) {
  constexpr InputKind kTable = {"a table", 64 * kMegabyte, true, ""};
  std::string text;
  for (int i = 0; i < 3000; ++i)
    text += std::string(static_cast<std::size_t>(i), static_cast<char>('a' + i % 26)) + "\n";
  InputFile file(write("table", text), kTable);
  std::string_view line;
  for (int i = 0; i < 3000; ++i) {
    ASSERT_TRUE(file.nextLine(line));
    ASSERT_EQ(line, std::string(static_cast<std::size_t>(i), static_cast<char>('a' + i % 26)));
  }
  EXPECT_FALSE(file.nextLine(line));
  const std::string endless = write("endless", std::string(10 * kMegabyte, 'x'));
  InputFile one_line(endless, kTable);
  EXPECT_TRUE(holds(errorOf([&] { one_line.nextLine(line); }), "endless:1: the line is longer than 65536 bytes"));
}

}  // namespace
}  // namespace pincer
