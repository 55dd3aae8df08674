// parameter: what there is to say of one number of a study beside its value: what it means, where it may lie, and what
// helps whoever is outside. Lists of them (tasks/lab/experiments/study_parameters.h) are what the reader, the writer,
// the check and the reference of study files follow.
#pragma once
#include <fmt/format.h>

#include <concepts>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pincer/tasks/run/files/strict_json.h"

namespace pincer::tasks {

struct Parameter {
  std::string meaning;                           // "of the sphere [m]"
  NumberRule rule = {};                          // of a number, or of each in a list
  std::span<const std::string_view> words = {};  // of an enumeration: the names of its values, in order
  bool may_be_null = false;                      // of a number: NaN stands for "there is none"
};

// A demand of two parameters on each other, or one that was never in a file: `path` is as in messages of files
// (conditions[1].staircase), so that the reader can say where in the file it stands.
class ParameterError : public InputError {
 public:
  ParameterError(std::string path, const std::string& message) : InputError(message), path_(std::move(path)) {}
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

template <class Field>
concept NumberField = std::same_as<Field, double> || std::same_as<Field, int>;

// A visitor of lists that refuses the first number out of its range. Throws ParameterError:
// "<of>: <key> = <value> is out of range ...".
class RangeCheck {
 public:
  // `path`: of the object in the file, "" for the whole file.
  explicit RangeCheck(std::string_view of, std::string_view path = "") : of_(of), path_(path) {}
  template <class Field>
  void operator()(std::string_view key, const Field& field, const Parameter& parameter) const {
    if constexpr (NumberField<Field>) {
      if (isWithin(static_cast<double>(field), parameter.rule) || (parameter.may_be_null && field != field)) return;
      throw ParameterError(fmt::format("{}{}{}", path_, path_.empty() ? "" : ".", key),
                           fmt::format("{}: {} = {} {}", of_, key, field, outOfRange(parameter.rule)));
    }
  }
  void operator()(std::string_view key, const std::vector<double>& field, const Parameter& parameter) const {
    for (const double each : field) (*this)(key, each, parameter);
  }
  void operator()(std::string_view key, const std::optional<double>& field, const Parameter& parameter) const {
    if (field) (*this)(key, *field, parameter);
  }

 private:
  std::string_view of_, path_;
};

}  // namespace pincer::tasks
