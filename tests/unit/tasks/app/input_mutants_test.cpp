// Damaged scenes, studies and trajectories: each is refused with an InputError, or taken; nothing else may happen, and
// none takes long. 500 mutants of each kind; PINCER_MUTANTS=N makes N, PINCER_LONG_TESTS a hundred times as many.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <ctime>
#include <filesystem>

#include "pincer/contact/io/printable.h"
#include "pincer/tasks/lab/experiments/manipulation_file.h"
#include "pincer/tasks/lab/sessions/study_file.h"
#include "pincer/tasks/run/scene.h"
#include "pincer/tasks/run/scene/builtin_scenes.h"
#include "pincer/tests/support/effort.h"
#include "pincer/tests/support/random_numbers.h"
#include "pincer/tests/support/temporary_directory.h"

namespace pincer::tasks {
namespace {

using tests::RandomNumbers;

int mutants() {
  const char* asked = std::getenv("PINCER_MUTANTS");
  return asked ? std::atoi(asked) : tests::draws(500, 100);
}

// Changes a text where it hurts: bytes, numbers, brackets, pieces doubled,
// dropped, swapped or put in from another text.
class Mutator {
 public:
  explicit Mutator(std::vector<std::string> texts) : texts_(std::move(texts)) {}

  std::string mutant(std::uint64_t seed) {
    RandomNumbers random(seed);
    std::string text = pick(random, texts_);
    for (int n = 1 + random.below(4); n > 0 && !text.empty(); --n) mutate(text, random);
    return text;
  }

 private:
  static std::size_t place(const std::string& text, RandomNumbers& random) {
    return static_cast<std::size_t>(random.below(static_cast<int>(text.size())));
  }
  static const std::string& pick(RandomNumbers& random, const std::vector<std::string>& from) {
    return from[static_cast<std::size_t>(random.below(static_cast<int>(from.size())))];
  }

  void mutate(std::string& text, RandomNumbers& random) {
    static const std::vector<std::string> kWords = {"-1",
                                                    "0",
                                                    "1e308",
                                                    "1e-308",
                                                    "-0.0",
                                                    "NaN",
                                                    "null",
                                                    "true",
                                                    "{}",
                                                    "[]",
                                                    "\"\"",
                                                    "1e999",
                                                    "0x10",
                                                    "\"\\u0000\"",
                                                    "\"\\ud800\"",
                                                    "[[[[",
                                                    "}}}",
                                                    ",",
                                                    ":",
                                                    "/*",
                                                    "//",
                                                    "\n",
                                                    "\r\n",
                                                    "\"end\"",
                                                    "\"mass\"",
                                                    "\x1b[2J",
                                                    "\xff",
                                                    "\xe2\x80\xae",
                                                    "9007199254740993",
                                                    "1e-6"};
    const std::size_t at = place(text, random),
                      length = std::min(text.size() - at, static_cast<std::size_t>(1 + random.below(40)));
    switch (random.below(8)) {
      case 0:
        text[at] = static_cast<char>(random.below(256));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(at, length));
        break;
      case 3:
        text.insert(at, pick(random, kWords));
        break;
      case 4:
        replaceNumber(text, at, pick(random, kWords));
        break;
      case 5:
        replaceNumber(text, at,
                      fmt::format("{}", std::pow(10.0, random.uniform(-320, 308)) * (random.below(4) ? 1 : -1)));
        break;
      case 6: {
        const std::string& other = pick(random, texts_);
        const std::size_t from = place(other, random);
        text.replace(at, length, other.substr(from, static_cast<std::size_t>(random.below(200))));
        break;
      }
      default:
        text.resize(at);
    }
  }

  static void replaceNumber(std::string& text, std::size_t at, const std::string& by) {
    const std::size_t begin = text.find_first_of("0123456789", at);
    if (begin == std::string::npos) return;
    const std::size_t end = std::min(text.find_first_not_of("0123456789.eE+-", begin), text.size());
    text.replace(begin, end - begin, by);
  }

  std::vector<std::string> texts_;
};

struct Fates {
  int taken = 0, refused = 0;
};

template <class Read>
Fates hammer(std::vector<std::string> texts, const Read& read) {
  constexpr double kLongest = PINCER_SANITIZED ? 60 : 15;  // of the processor [s]
  Mutator mutator(std::move(texts));
  Fates fates;
  for (int n = 0; n < mutants(); ++n) {
    const std::string text = mutator.mutant(static_cast<std::uint64_t>(n));
    const std::clock_t start = std::clock();
    try {
      read(text);
      ++fates.taken;
    } catch (const InputError& error) {
      const std::string said = error.what();
      EXPECT_FALSE(said.empty());
      EXPECT_LT(said.size(), 3 * kLongestMessage) << text;
      EXPECT_EQ(said.find('\x1b'), std::string::npos) << text;
      ++fates.refused;
    } catch (const std::exception& error) {
      ADD_FAILURE() << "mutant " << n << ": " << error.what() << "\n" << text;
    }
    EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, kLongest) << "mutant " << n << ":\n" << text;
  }
  EXPECT_GT(fates.refused, 0);
  return fates;
}

TEST(Mutants, OfScenesAreTakenOrRefused) {
  std::vector<std::string> scenes;
  for (const BuiltinScene& scene : builtinScenes()) scenes.emplace_back(scene.json);
  hammer(scenes, [](const std::string& text) { buildWorld(parseScene(text, "mutant.json")); });
}

TEST(Mutants, OfStudiesAreTakenOrRefused) {
  hammer({studyFile(ManipulationStudy{})}, [](const std::string& text) { parseStudyFile(text, "mutant.json"); });
  const std::vector<std::string> arcs = {studyJson(smoothnessStudy()), studyJson(backlashStudy()),
                                         studyJson(delayStudy())};
  hammer(arcs, [](const std::string& text) {
    ArcStudy study = delayStudy();
    parseStudy(text, "mutant.json", study);
  });
  hammer({studyJson(ShapeStudy{}), studyJson(LocalisationStudy{})}, [](const std::string& text) {
    ShapeStudy study;
    parseStudy(text, "mutant.json", study);
  });
}

TEST(Mutants, OfTrajectoriesAreTakenOrRefused) {
  const tests::TemporaryDirectory folder;
  std::string rows = "time,x,y,z\n", crlf = "time,x,y,z\r\n";
  for (int i = 0; i < 60; ++i) {
    rows += fmt::format("{},{},{},{}\n", 0.01 * i, 1e-3 * i, -1e-4 * i, 0.02);
    crlf += fmt::format("{},0,0,{}\r\n", 1e-3 * i, 1e-5 * i);
  }
  hammer({rows, crlf}, [&](const std::string& text) {
    std::ofstream(folder / "path.csv", std::ios::binary) << text;
    const Trajectory path = readTrajectoryCsv(folder / "path.csv");
    for (const double t : {-1e6, 0.0, 0.0123, 0.5, 1e6}) {
      const TimedPoint p = path.at(t);
      EXPECT_TRUE(p.p_W.allFinite() && p.v_W.allFinite()) << text;
    }
  });
}

}  // namespace
}  // namespace pincer::tasks
