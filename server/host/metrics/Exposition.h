// Writes metrics as text: Prometheus' format, version 0.0.4
// (https://prometheus.io/docs/instrumenting/exposition_formats/).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "host/process/StageClock.h"

namespace naiad {

/// The Content-Type of the text.
inline constexpr std::string_view kExpositionType = "text/plain; version=0.0.4; charset=utf-8";

enum class MetricType { kCounter, kGauge, kHistogram };

class Exposition {
 public:
  /// Begins a family of metrics; the samples that follow belong to it. `name` and `help` are plain ASCII
  /// without quotes, backslashes or line ends.
  void begin(std::string_view name, MetricType type, std::string_view help);
  /// Adds a sample. `labels`: the text between the braces, like R"(reason="full")"; may be empty.
  void add(std::string_view labels, std::uint64_t value);
  void add(std::string_view labels, double value);
  /// Adds the buckets, sum and count of a histogram.
  void add(const Histogram& histogram);

  const std::string& text() const { return m_text; }

 private:
  void addName(std::string_view suffix, std::string_view labels);

  std::string m_text;
  std::string m_name;
};

/// Returns `name="value"`, with backslashes, quotes and line ends in the value escaped.
std::string metricLabel(std::string_view name, std::string_view value);

}  // namespace naiad
