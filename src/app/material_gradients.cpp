#include "material_gradients.hpp"

#include "evert/core/error.hpp"
#include "evert/core/value.hpp"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace evert {
namespace {

constexpr std::string_view separators = " \t,\r";

/// Throws UserError "<where>: ...".
double number_of(std::string_view word, const std::string& where) {
  const auto digits = word.substr(word.starts_with('+') ? 1 : 0);
  double number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error == std::errc::result_out_of_range)
    throw UserError(where + schema::shown(word) + " does not fit into a double-precision number");
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(number))
    throw UserError(where + schema::shown(word) + " is no finite number");
  return number;
}

std::vector<double> numbers_of(std::string_view line, const std::string& where) {
  std::vector<double> numbers;
  for (auto begin = line.find_first_not_of(separators); begin != std::string_view::npos;
       begin = line.find_first_not_of(separators, begin)) {
    const auto end = std::min(line.find_first_of(separators, begin), line.size());
    numbers.push_back(number_of(line.substr(begin, end - begin), where));
    begin = end;
  }
  return numbers;
}

}  // namespace

std::vector<Mat3d> read_deformation_gradients(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw UserError(path + ": is a directory");
  std::ifstream file(path);
  if (!file) throw UserError(path + ": there is no such file that can be read");
  std::vector<Mat3d> gradients;
  std::size_t line_number = 0;
  for (std::string line; std::getline(file, line);) {
    const auto where = path + ":" + std::to_string(++line_number) + ": ";
    const auto numbers = numbers_of(std::string_view(line).substr(0, line.find('#')), where);
    if (numbers.empty()) continue;
    if (numbers.size() != 9)
      throw UserError(where + "holds " + std::to_string(numbers.size()) +
                      " numbers: a deformation gradient has 9, row by row");
    Mat3d f;
    for (std::size_t i = 0; i < 9; ++i) f(i / 3, i % 3) = numbers[i];
    gradients.push_back(f);
  }
  if (gradients.empty()) throw UserError(path + ": holds no deformation gradient: 9 numbers a line");
  return gradients;
}

}  // namespace evert
