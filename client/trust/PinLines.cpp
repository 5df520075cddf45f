#include "client/trust/PinLines.h"

#include <algorithm>

#include "client/trust/ServerAddress.h"

namespace naiad {
namespace {

constexpr std::string_view kBlanks = " \t\r";

bool isComment(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  return first == std::string_view::npos || text[first] == '#';
}

}  // namespace

std::string lowerCase(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

PinLines::PinLines(std::string_view content) {
  while (!content.empty()) {
    const std::size_t end = std::min(content.find('\n'), content.size());
    lines_.push_back(parse(content.substr(0, end)));
    content.remove_prefix(std::min(end + 1, content.size()));
  }
}

PinLines::Line PinLines::parse(std::string_view text) {
  Line line{std::string(text), "", std::nullopt};
  if (isComment(text)) return line;
  const std::size_t end = std::min(text.find_last_not_of(kBlanks) + 1, text.size());
  const std::size_t begin = std::min(text.find_first_not_of(kBlanks), end);
  const std::string_view rest = text.substr(begin, end - begin);
  const std::size_t blank = rest.find_first_of(kBlanks);
  if (blank == std::string_view::npos) return line;
  const std::size_t second = rest.find_first_not_of(kBlanks, blank);
  const auto address = ServerAddress::parse(std::string(rest.substr(0, blank)));
  const auto key = Fingerprint::parse(rest.substr(second));
  // Compared as written: the same address in another spelling is not found.
  if (!address || !key || address->text() != rest.substr(0, blank)) return line;
  line.server = lowerCase(address->text());
  line.key = key;
  return line;
}

std::string PinLines::content() const {
  std::string all;
  for (const Line& line : lines_) all += line.text + '\n';
  return all;
}

std::optional<Fingerprint> PinLines::find(std::string_view server) const {
  std::optional<Fingerprint> found;
  for (const Line& line : lines_) {
    if (line.key && line.server == server) found = line.key;
  }
  return found;
}

void PinLines::set(std::string_view server, const Fingerprint& key) {
  std::erase_if(lines_, [&](const Line& line) { return line.key && line.server == server; });
  lines_.push_back(parse(std::string(server) + ' ' + key.text()));
}

std::vector<std::size_t> PinLines::malformed() const {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (!lines_[i].key && !isComment(lines_[i].text)) numbers.push_back(i + 1);
  }
  return numbers;
}

}  // namespace naiad
