// How the library fails inside: an Error carries the status and the text that the host will read. The C entry points catch it, so it
// never crosses the boundary.
#pragma once

#include <exception>
#include <string>
#include <utility>

#include <loam/base.h>

namespace loam {

class Error : public std::exception {
public:
  Error(loam_status status, std::string text) : status_(status), text_(std::move(text)) {}
  loam_status status() const { return status_; }
  const char *what() const noexcept override { return text_.c_str(); }

private:
  loam_status status_;
  std::string text_;
};

// Text from a printf format; kept in one place so that no other file needs <cstdarg>.
__attribute__((format(printf, 1, 2))) std::string format(const char *pattern, ...);

} // namespace loam
