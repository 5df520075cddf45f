#include "host/metrics/Exposition.h"

#include <array>
#include <charconv>

namespace naiad {

namespace {

constexpr const char* kTypes[] = {"counter", "gauge", "histogram"};

void appendNumber(std::string& text, std::uint64_t value) {
  text += std::to_string(value);
}

/// Appends the shortest text without an exponent that parses to the number. Independent of the locale.
void appendNumber(std::string& text, double value) {
  std::array<char, 1100> digits;  // enough for the smallest number
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed).ptr;
  text.append(digits.data(), end);
}

/// Appends a bucket's bound, without an exponent because bounds are compared by their text.
void appendBound(std::string& text, double bound) {
  std::array<char, 512> digits;
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), bound, std::chars_format::fixed).ptr;
  text.append(digits.data(), end);
}

}  // namespace

void Exposition::begin(std::string_view name, MetricType type, std::string_view help) {
  m_name = name;
  m_text.append("# HELP ").append(name).append(" ").append(help).append("\n# TYPE ").append(name);
  m_text.append(" ").append(kTypes[static_cast<std::size_t>(type)]).append("\n");
}

void Exposition::addName(std::string_view suffix, std::string_view labels) {
  m_text.append(m_name).append(suffix);
  if (!labels.empty()) m_text.append("{").append(labels).append("}");
  m_text += ' ';
}

void Exposition::add(std::string_view labels, std::uint64_t value) {
  addName("", labels);
  appendNumber(m_text, value);
  m_text += '\n';
}

void Exposition::add(std::string_view labels, double value) {
  addName("", labels);
  appendNumber(m_text, value);
  m_text += '\n';
}

void Exposition::add(const Histogram& histogram) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i <= histogram.bounds().size(); ++i) {
    count += histogram.count(i);
    std::string bound = "le=\"";
    i < histogram.bounds().size() ? appendBound(bound, histogram.bounds()[i])
                                  : static_cast<void>(bound += "+Inf");
    addName("_bucket", bound + "\"");
    appendNumber(m_text, count);
    m_text += '\n';
  }
  addName("_sum", "");
  appendNumber(m_text, histogram.sum());
  m_text += '\n';
  addName("_count", "");
  appendNumber(m_text, count);
  m_text += '\n';
}

std::string metricLabel(std::string_view name, std::string_view value) {
  std::string text(name);
  text += "=\"";
  for (const char c : value) {
    if (c == '\\' || c == '"') text += '\\';
    c == '\n' ? text += "\\n" : text += c;
  }
  return text + '"';
}

}  // namespace naiad
