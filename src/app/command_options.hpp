#pragma once
#include "evert/math/vec3.hpp"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace evert {

/// The options and the other arguments of one command such as `evert mesh convert`. Options may be written
/// with one dash or two.
class CommandOptions {
 public:
  /// `command`: as the user calls it, "evert mesh convert". `with_value`, `switches`: all option names
  /// without dashes; `files`: what the other arguments are called, all needed. Throws UserError for anything
  /// else on the command line.
  CommandOptions(std::string command, std::span<const std::string> arguments,
                 std::vector<std::string> with_value, const std::vector<std::string>& switches,
                 const std::vector<std::string>& files);

  [[nodiscard]] const std::string& file(std::size_t i) const { return files_[i]; }
  [[nodiscard]] bool has(const std::string& option) const { return values_.contains(option); }
  /// The value of an option. Throws UserError when it is missing or of another kind.
  [[nodiscard]] std::string text(const std::string& option) const;
  [[nodiscard]] double number(const std::string& option) const;
  [[nodiscard]] int whole_number(const std::string& option) const;
  [[nodiscard]] Vec3d three_numbers(const std::string& option) const;

 private:
  template <class Number>
  [[nodiscard]] std::vector<Number> numbers(const std::string& option, std::size_t count,
                                            const char* kind) const;

  std::string command_;
  std::map<std::string, std::string> values_;
  std::vector<std::string> files_;
};

}  // namespace evert
