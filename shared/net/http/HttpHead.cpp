#include "shared/net/http/HttpHead.h"

#include <algorithm>

namespace naiad {
namespace {

bool isBlank(char c) {
  return c == ' ' || c == '\t';
}

char toLower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
}

bool isTokenCharacter(char c) {
  const bool is_letter_or_digit = (c >= '0' && c <= '9') || (toLower(c) >= 'a' && toLower(c) <= 'z');
  return is_letter_or_digit || std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

/// True for a character that a line may contain (RFC 9110 5.5), including bytes above ASCII.
bool isTextCharacter(char c) {
  return c == '\t' || (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f);
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

bool isHttpToken(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, isTokenCharacter);
}

bool equalsIgnoringCase(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, {}, toLower, toLower);
}

std::optional<std::pair<std::string, std::string>> parseHttpField(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || !isHttpToken(line.substr(0, colon))) return std::nullopt;
  std::string name(line.substr(0, colon));
  std::ranges::transform(name, name.begin(), toLower);
  return std::pair(std::move(name), std::string(trim(line.substr(colon + 1))));
}

std::optional<HttpRequestLine> HttpRequestLine::parse(std::string_view line) {
  const std::size_t first = std::min(line.find(' '), line.size());
  const std::size_t last = std::min(line.rfind(' '), line.size());
  const std::string_view version = line.substr(std::min(last + 1, line.size()));
  if (first >= last || (version != "HTTP/1.1" && version != "HTTP/1.0")) return std::nullopt;
  const HttpRequestLine request{line.substr(0, first), line.substr(first + 1, last - first - 1)};
  const bool is_target = std::ranges::all_of(request.target, [](char c) { return c > ' ' && c < 0x7f; });
  if (!isHttpToken(request.method) || request.target.empty() || !is_target) return std::nullopt;
  return request;
}

std::string_view HttpHead::value(std::string_view name) const {
  const auto found = std::ranges::find(fields, name, [](const auto& field) { return field.first; });
  return found == fields.end() ? std::string_view() : std::string_view(found->second);
}

std::size_t HttpHead::count(std::string_view name) const {
  return static_cast<std::size_t>(
      std::ranges::count(fields, name, [](const auto& field) { return field.first; }));
}

bool HttpHead::lists(std::string_view name, std::string_view element) const {
  for (const auto& [key, value] : fields) {
    if (key != name) continue;
    std::string_view rest = value;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(','), rest.size());
      if (equalsIgnoringCase(trim(rest.substr(0, end)), element)) return true;
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  return false;
}

std::optional<std::string_view> HttpLines::next(std::string_view& bytes) {
  if (m_complete) m_line.clear();
  m_complete = false;
  if (m_error != HttpError::kNone) return std::nullopt;
  const std::size_t found = bytes.find('\n');
  const std::size_t wanted = found == std::string_view::npos ? bytes.size() : found + 1;
  const std::size_t taken = std::min(wanted, m_limit - m_used);
  m_line.append(bytes.substr(0, taken));
  bytes.remove_prefix(taken);
  m_used += taken;
  if (taken < wanted) {
    m_error = HttpError::kHeadTooLong;
    return std::nullopt;
  }
  if (!m_line.ends_with('\n')) return std::nullopt;
  m_complete = true;
  const std::string_view line(m_line.data(), m_line.size() - std::min<std::size_t>(m_line.size(), 2));
  if (m_line.ends_with("\r\n") && std::ranges::all_of(line, isTextCharacter)) return line;
  m_error = HttpError::kMalformed;
  return std::nullopt;
}

void HttpHeadReader::feed(std::string_view& bytes) {
  while (!m_done && m_error == HttpError::kNone) {
    const auto line = m_lines.next(bytes);
    m_error = m_lines.error();
    if (!line) return;
    handleLine(*line);
  }
}

void HttpHeadReader::handleLine(std::string_view line) {
  if (!std::exchange(m_has_start, true)) {
    m_head.start_line = line;
    if (line.empty()) m_error = HttpError::kMalformed;
  } else if (line.empty()) {
    m_done = true;
  } else if (auto field = parseHttpField(line)) {
    m_head.fields.push_back(*std::move(field));
  } else {
    m_error = HttpError::kMalformed;
  }
}

}  // namespace naiad
