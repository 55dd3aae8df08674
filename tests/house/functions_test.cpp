// The same bits on every processor: none of our libraries may call the C library's functions of analysis, which choose
// their instructions, and with them how they round, by the processor (contact/functions/elementary.h has ours).
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <set>
#include <sstream>
#include <string>

namespace {

// Real and complex, of all sizes of numbers. Not here: those that IEEE 754 or their definition round exactly
// (sqrt, fmod, remainder, fma, floor, ldexp ..).
std::set<std::string> forbidden() {
  std::set<std::string> names;
  for (const std::string real :
       {"sin",   "cos",   "sincos", "tan", "asin", "acos",  "atan",   "atan2",  "sinh",    "cosh",  "tanh",
        "asinh", "acosh", "atanh",  "exp", "exp2", "exp10", "expm1",  "log",    "log2",    "log10", "log1p",
        "pow",   "hypot", "cbrt",   "erf", "erfc", "gamma", "lgamma", "tgamma", "lgamma_r"}) {
    for (const char* size : {"", "f", "l", "f32", "f64", "f128"}) names.insert(real + size);
  }
  for (const std::string complex : {"cabs", "carg", "cexp", "clog", "cpow", "csqrt", "csin", "ccos", "ctan", "csinh",
                                    "ccosh", "ctanh", "casin", "cacos", "catan"}) {
    for (const char* size : {"", "f", "l"}) names.insert(complex + size);
  }
  return names;
}

// The symbols, as `nm` prints them, that the objects of an archive take from elsewhere.
std::string undefinedSymbols(const std::string& archive) {
  const std::unique_ptr<FILE, int (*)(FILE*)> nm(popen(("nm -A --undefined-only " + archive).c_str(), "r"), pclose);
  std::string text;
  for (char block[4096]; nm && std::fgets(block, sizeof block, nm.get());) text += block;
  return text;
}

TEST(House, NoLibraryCallsFunctionsOfTheProcessor) {
  const std::set<std::string> names = forbidden();
  std::istringstream archives(PINCER_ARCHIVES);
  for (std::string archive; std::getline(archives, archive, ':');) {
    const std::string text = undefinedSymbols(archive);
    EXPECT_NE(text.find(" U "), std::string::npos) << "nm says nothing of " << archive;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const std::string name = line.substr(line.rfind(' ') + 1), base = name.substr(0, name.find('@'));
      EXPECT_FALSE(names.count(base)) << line << "\nWrite math::" << base
                                      << " (contact/functions/elementary.h) in place of std::" << base
                                      << ", or find what calls it (Eigen's AngleAxis and slerp do).";
    }
  }
}

}  // namespace
