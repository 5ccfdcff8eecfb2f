#include "command_options.hpp"

#include "evert/core/error.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace evert {
namespace {

/// An argument that begins with a dash and is no negative number.
bool is_option(const std::string& argument) {
  return argument.size() > 1 && argument[0] == '-' && argument[1] != '.' &&
         (argument[1] < '0' || argument[1] > '9');
}

std::vector<std::string> with_dashes(const std::vector<std::string>& names) {
  std::vector<std::string> options;
  for (const auto& name : names) options.push_back("-" + name);
  return options;
}

bool is_finite(double value) { return std::isfinite(value); }
bool is_finite(int /*value*/) { return true; }

}  // namespace

CommandOptions::CommandOptions(std::string command, std::span<const std::string> arguments,
                               std::vector<std::string> with_value, const std::vector<std::string>& switches,
                               const std::vector<std::string>& files)
    : command_(std::move(command)) {
  auto known = with_value;
  known.insert(known.end(), switches.begin(), switches.end());
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const auto& argument = arguments[i];
    if (!is_option(argument)) {
      files_.push_back(argument);
      continue;
    }
    const auto name = argument.substr(argument.starts_with("--") ? 2 : 1);
    const auto listed = with_dashes(known);
    if (std::ranges::find(known, name) == known.end())
      throw UserError(command_ + ": there is no option " + argument + ": must be " + list_of(listed) +
                      did_you_mean("-" + name, listed));
    if (values_.contains(name)) throw UserError(command_ + ": -" + name + " is given twice");
    const bool takes_value = std::ranges::find(with_value, name) != with_value.end();
    if (takes_value && i + 1 == arguments.size()) throw UserError(command_ + ": -" + name + " needs a value");
    values_[name] = takes_value ? arguments[++i] : "";
  }
  if (files_.size() > files.size())
    throw UserError(command_ + ": '" + files_[files.size()] + "' is one argument too many");
  if (files_.size() < files.size()) throw UserError(command_ + " needs " + files[files_.size()]);
}

std::string CommandOptions::text(const std::string& option) const {
  const auto found = values_.find(option);
  if (found == values_.end()) throw UserError(command_ + " needs -" + option);
  return found->second;
}

template <class Number>
std::vector<Number> CommandOptions::numbers(const std::string& option, std::size_t count,
                                            const char* kind) const {
  const auto value = text(option);
  std::vector<Number> result;
  const char* at = value.data();
  const char* const end = at + value.size();
  while (result.size() < count) {
    Number number{};
    const auto [next, error] = std::from_chars(at, end, number);
    const bool last = result.size() + 1 == count;
    const bool separated = last ? next == end : next != end && *next == ',';
    if (error != std::errc{} || !separated || !is_finite(number))
      throw UserError(command_ + ": -" + option + " must be " + kind + ", not '" + value + "'");
    result.push_back(number);
    at = last ? next : next + 1;
  }
  return result;
}

double CommandOptions::number(const std::string& option) const {
  return numbers<double>(option, 1, "a finite number").front();
}

int CommandOptions::whole_number(const std::string& option) const {
  return numbers<int>(option, 1, "a whole number").front();
}

Vec3d CommandOptions::three_numbers(const std::string& option) const {
  const auto values = numbers<double>(option, 3, "three finite numbers like 1,0.5,2");
  return {values[0], values[1], values[2]};
}

}  // namespace evert
