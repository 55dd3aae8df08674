#include "pincer/tests/campaign/rows.h"

namespace pincer::campaign {

const std::vector<Row>& rows() {
  static const std::vector<Row> kRows = {
      {"options", "every command x every option: absurd, missing, twice, unknown", 500, harmCommandLine,
       allCommandLines},
      {"scenes", "scene files: bytes, tokens, numbers, keys, nesting, NUL, huge names; sim, plan", 700, harmScene},
      {"studies", "study files of six experiments, likewise", 400, harmStudy},
      {"trajectories", "trajectory tables", 250, harmTrajectory},
      {"meshes", "OBJ, STL, PLY, OFF, text and binary; info, check, convert --repair, round-edges, simplify, subdivide",
       700, harmMesh},
      {"device-files", "recordings and calibrations", 100, harmDeviceFile},
      {"special-files", "devices, pipes, folders, loops, 300 MB in place of each input", 320, useSpecialFile,
       allSpecialFiles},
      {"session-columns", "every column of every table: other types, ranges, texts; report, export, replay, --resume",
       100, damageColumn, allDamagedColumns},
      {"session-bytes", "session files: bytes flipped, cut off", 50, damageSessionFile},
      {"kills", "kill -9 at any moment, then --resume", 20, killSession},
      {"two-programs", "two programs on one session", 4, runTwoPrograms},
      {"signals", "INT, TERM, HUP at any moment of run, report, export, sweep", 24, signalProgram},
      {"failing-calls", "the N-th write, fsync, rename, open, mmap ... fails", 90, failCall},
      {"failing-allocations", "the N-th allocation fails", 90, failAllocation},
      {"every-failure", "each call and each allocation fails, up to the 1,000th of a kind", 120, failEach, allFailures},
      {"streams", "standard streams closed, full, cut off", 100, breakStreams, allStreams},
      {"planted-links", "links at names that the program might write through", 30, plantLinks},
      {"full-disks", "no space, read-only folders, file size limits", 30, fillDisk},
      {"hostile-names", "names with quotes, escapes, commands, formulae, through every output", 60, useHostileNames},
      {"surroundings", "locales, no HOME, no TERM, no PATH, no TMPDIR", 60, changeSurroundings, allSurroundings},
      {"processors", "the same bits without AVX, AVX2, FMA", 8, changeProcessor, allProcessors},
      {"usb-frames", "64 bytes, random or mutated", 10, harmFrames},
      {"usb-messages", "sound frames with other payloads", 10, harmMessages},
      {"falcon-packets", "bytes of a Falcon", 10, harmFalconPackets},
  };
  return kRows;
}

}  // namespace pincer::campaign
