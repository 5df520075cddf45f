#include "shared/admin/AdminAnswer.h"

#include <algorithm>
#include <cstdio>

#include "shared/net/base/SafeText.h"
#include "shared/program/LogText.h"

namespace naiad {
namespace {

std::string cellText(const AdminValue& value) {
  const std::string text = oneLine(valueText(value));
  return text.empty() ? "-" : text;
}

std::string heading(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

void addPadded(std::string& line, const std::string& cell, std::size_t width, bool is_last) {
  line += cell;
  if (!is_last) line.append(width + 2 - std::min(width, columnsOf(cell)), ' ');
}

std::vector<std::string> columnsText(const std::vector<AdminRow>& rows) {
  const std::size_t count = rows.front().size();
  std::vector<std::size_t> widths(count);
  for (std::size_t i = 0; i < count; ++i) {
    widths[i] = columnsOf(heading(rows.front()[i].first));
    for (const AdminRow& row : rows) {
      if (i < row.size()) widths[i] = std::max(widths[i], columnsOf(cellText(row[i].second)));
    }
  }
  std::vector<std::string> lines(1);
  for (std::size_t i = 0; i < count; ++i)
    addPadded(lines[0], heading(rows.front()[i].first), widths[i], i + 1 == count);
  for (const AdminRow& row : rows) {
    std::string& line = lines.emplace_back();
    for (std::size_t i = 0; i < row.size() && i < count; ++i)
      addPadded(line, cellText(row[i].second), widths[i], i + 1 == count);
  }
  return lines;
}

}  // namespace

std::string valueText(const AdminValue& value) {
  if (const auto* p_text = std::get_if<std::string>(&value)) return *p_text;
  if (const auto* p_flag = std::get_if<bool>(&value)) return *p_flag ? "yes" : "";
  if (const auto* p_number = std::get_if<std::int64_t>(&value)) return std::to_string(*p_number);
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", std::get<double>(value));
  return text;
}

std::vector<std::string> answerText(const AdminAnswer& answer) {
  std::vector<std::string> lines;
  if (!answer.text.empty()) lines.push_back(oneLine(answer.text));
  for (const std::string& name : answer.candidates) lines.push_back("  " + oneLine(name));
  for (const auto& [name, value] : answer.facts) lines.push_back(heading(name) + ": " + cellText(value));
  if (!answer.rows.empty()) {
    for (std::string& line : columnsText(answer.rows)) lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace naiad
