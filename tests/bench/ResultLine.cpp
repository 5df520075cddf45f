#include "ResultLine.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace bench {
namespace {

constexpr int kDigits = 4;
constexpr int kMaxDecimals = 24;

bool s_all_equal = true;
std::FILE* s_out = stdout;

}  // namespace

Line::~Line() {
  std::fprintf(s_out, "%s\n", m_text.c_str());
  std::fflush(s_out);
}

Line& Line::add(const std::string& key, const std::string& value) {
  m_text += " " + key + "=" + value;
  return *this;
}

Line& Line::add(const std::string& key, long long value) {
  return add(key, std::to_string(value));
}

Line& Line::add(const std::string& key, double value) {
  int decimals = 0;
  if (value != 0 && std::isfinite(value)) {
    decimals = std::max(0, kDigits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
  }
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", std::min(decimals, kMaxDecimals), value);
  std::string digits = text;
  if (digits.find('.') != std::string::npos) {
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.back() == '.') digits.pop_back();
  }
  return add(key, digits);
}

Line& Line::addEqual(bool equal) {
  if (!equal) s_all_equal = false;
  return add("equal", equal ? 1 : 0);
}

Line& Line::addZero(const std::string& key, long long errors) {
  if (errors != 0) s_all_equal = false;
  return add(key, errors);
}

void reserveStdout() {
  const int out = dup(STDOUT_FILENO);
  if (out < 0 || dup2(STDERR_FILENO, STDOUT_FILENO) < 0)
    throw std::runtime_error("stdout cannot be duplicated");
  s_out = fdopen(out, "w");
  if (s_out == nullptr) throw std::runtime_error("stdout cannot be opened again");
}

bool allEqual() {
  return s_all_equal;
}

void progress(const std::string& what) {
  std::fprintf(stderr, "-- %s\n", what.c_str());
}

}  // namespace bench
