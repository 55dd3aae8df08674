// Special files in place of each input: devices, pipes, sockets, folders, loops, nothing, no permission, 300 MB.
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <fstream>

#include "pincer/tests/campaign/inputs.h"
#include "pincer/tests/campaign/rows.h"

namespace pincer::campaign {
namespace {

constexpr std::uintmax_t kHuge = 300'000'000;  // [bytes]
constexpr long kMostMemory = 400;              // [MB] that a refusal may take

struct Special {
  const char* what;
  void (*make)(const fs::path& file);
};

void linkTo(const char* target, const fs::path& file) { fs::create_symlink(target, file); }

void makeSocket(const fs::path& file) {
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const fs::path back = fs::current_path();
  fs::current_path(file.parent_path());  // the address holds 108 characters
  std::strncpy(address.sun_path, file.filename().c_str(), sizeof address.sun_path - 1);
  ::bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof address);
  fs::current_path(back);
  ::close(socket);
}

void makeHuge(const fs::path& file, const char* begins) {
  { std::ofstream(file) << begins; }
  fs::resize_file(file, kHuge);
}

const std::vector<Special>& specials() {
  static const std::vector<Special> kSpecials = {
      {"/dev/zero", [](const fs::path& f) { linkTo("/dev/zero", f); }},
      {"/dev/full", [](const fs::path& f) { linkTo("/dev/full", f); }},
      {"/dev/null", [](const fs::path& f) { linkTo("/dev/null", f); }},
      {"/dev/urandom", [](const fs::path& f) { linkTo("/dev/urandom", f); }},
      {"/proc/self/mem", [](const fs::path& f) { linkTo("/proc/self/mem", f); }},
      {"pipe", [](const fs::path& f) { ::mkfifo(f.c_str(), 0644); }},
      {"socket", makeSocket},
      {"folder", [](const fs::path& f) { fs::create_directory(f); }},
      {"empty", [](const fs::path& f) { std::ofstream{f}; }},
      {"loop", [](const fs::path& f) { linkTo(f.filename().c_str(), f); }},
      {"dangling", [](const fs::path& f) { linkTo("nothing-there", f); }},
      {"unreadable",
       [](const fs::path& f) {
         std::ofstream(f) << "{}";
         fs::permissions(f, fs::perms::none);
       }},
      {"300 MB of NUL", [](const fs::path& f) { makeHuge(f, ""); }},
      {"300 MB after {", [](const fs::path& f) { makeHuge(f, "{\n"); }},
      {"300 MB after a header", [](const fs::path& f) { makeHuge(f, "time,x,y,z\n0,0,0,0\n"); }},
      {"nothing", [](const fs::path&) {}},
  };
  return kSpecials;
}

struct Reader {
  std::string file;
  std::vector<std::string> arguments;
  const char* beside;  // a file of the campaign that has to be there, or none
};

const std::vector<Reader>& readers() {
  static const std::vector<Reader> kReaders = {
      {"in.json", {"sim", "in.json", "--duration", "0.05"}, ""},
      {"in.json", {"plan", "in.json"}, ""},
      {"in.json", {"sweep", "in.json", "--vary", "duration=0.01,0.02"}, ""},
      {"trajectory.csv", {"sim", "scene.json", "--duration", "0.05"}, "trajectory/scene.json"},
      {"in.json", {"run", "delay-discrimination", "--study", "in.json", "--print-study"}, ""},
      {"in.json", {"run", "manipulation", "--study", "in.json", "--write-study", "out.json"}, ""},
      {"in.obj", {"mesh", "info", "in.obj", "--units", "m"}, ""},
      {"in.stl", {"mesh", "check", "in.stl", "--units", "m"}, ""},
      {"in.ply", {"mesh", "convert", "in.ply", "out.obj", "--repair"}, ""},
      {"in.off", {"mesh", "round-edges", "in.off", "out.obj"}, ""},
      {"in.obj", {"run", "sphere-pickup", "--object", "in.obj", "--no-report", "--out", "out"}, ""},
      {"in.db", {"report", "in.db"}, ""},
      {"in.db", {"export", "in.db", "--out", "csv"}, ""},
      {"in.db", {"export", "in.db", "--bids", "bids"}, ""},
      {"in.db", {"replay", "in.db"}, ""},
      {"session.db", {"run", "sphere-pickup", "--resume", "--out", "."}, ""},
      {"in.csv", {"run", "sphere-pickup", "--devices", "replay", "--recording", "in.csv", "--yes", "--out", "out"}, ""},
      {"in.json", {"devices", "calibrate", "NONE", "--load", "in.json"}, ""},
      {"in.json",
       {"run", "sphere-pickup", "--devices", "usb", "--calibration", "in.json", "--yes", "--out", "out"},
       ""},
      {"in.bin", {"run", "sphere-pickup", "--devices", "falcon", "--firmware", "in.bin", "--yes", "--out", "out"}, ""},
  };
  return kReaders;
}

}  // namespace

int allSpecialFiles(const Ground&) { return static_cast<int>(specials().size() * readers().size()); }

void useSpecialFile(Case& c) {
  const std::size_t which = scattered(c.ground, c.number, specials().size() * readers().size());
  const Special& special = specials()[which % specials().size()];
  const Reader& reader = readers()[which / specials().size()];
  if (*reader.beside != '\0')
    fs::copy_file(c.ground.inputs() / reader.beside, c.folder / fs::path(reader.beside).filename());
  special.make(c.folder / reader.file);
  Launch launch = c.pincer(reader.arguments);
  launch.limit = 4;
  launch.owner_rights = true;
  const bool no_device = reader.arguments.back() == "out" && reader.arguments[2] == "--devices";
  const Expect expect{.name = no_device ? "" : reader.file, .codes = {2, 3, 4}, .most_memory = kMostMemory};
  c.run(launch, expect);
}

}  // namespace pincer::campaign
