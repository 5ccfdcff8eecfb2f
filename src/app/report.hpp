#pragma once
#include "evert/core/formatted.hpp"

#include <ostream>
#include <string>

namespace evert {

/// Writes "title   text", the title only when it differs from the line before.
class Report {
 public:
  explicit Report(std::ostream& out) : out_(out) {}

  void line(const std::string& title, const std::string& text) {
    out_ << formatted("%-13s", title == last_ ? "" : title.c_str()) << text << '\n';
    last_ = title;
  }

 private:
  std::ostream& out_;
  std::string last_;
};

}  // namespace evert
