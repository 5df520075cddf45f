#include "host/world/ActivityReader.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace naiad {

namespace {

constexpr std::string_view kUnknown = "an Object of unknown class";

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// Returns the last name in a sequence like "5naiad4Ship"; empty if it has no name, or a wrong length.
std::string_view lastOfNames(std::string_view rest) {
  std::string_view last;
  while (!rest.empty() && isDigit(rest.front())) {
    std::size_t size = 0;
    for (; !rest.empty() && isDigit(rest.front()) && size < 1000; rest.remove_prefix(1))
      size = size * 10 + static_cast<std::size_t>(rest.front() - '0');
    if (size == 0 || size > rest.size()) return {};
    last = rest.substr(0, size);
    rest.remove_prefix(size);
  }
  return last;
}

/// Copies a text, because the writer may still be changing it.
template <std::size_t N>
std::string_view copyText(const char (&from)[N], char (&to)[N]) {
  std::memcpy(to, from, N);
  return {to, strnlen(to, N)};
}

void addName(const df::ActivityPage& page, std::uintptr_t id, ActivityText& text, std::string_view unknown) {
  for (const df::ActivityPage::Name& name : page.names) {
    if (name.id.load(std::memory_order_acquire) != id) continue;
    char copy[sizeof name.text];
    return text.addEscaped(classInMangled(copyText(name.text, copy)));
  }
  text.add(unknown);
}

}  // namespace

void ActivityText::add(std::string_view text) {
  const std::size_t size = std::min(text.size(), sizeof m_text - m_size);
  std::memcpy(m_text + m_size, text.data(), size);
  m_size += size;
}

void ActivityText::addEscaped(std::string_view text) {
  constexpr char kDigits[] = "0123456789abcdef";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f) {
      add({&c, 1});
    } else {
      const char escape[] = {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
      add({escape, sizeof escape});
    }
  }
}

std::string_view classInMangled(std::string_view mangled) {
  std::string_view rest = mangled;
  if (rest.starts_with('*')) rest.remove_prefix(1);  // a class local to one source file
  if (rest.starts_with('Z')) {  // a class in a function: the name after that of the function
    std::size_t at = rest.size();
    while (at > 0 && !(rest[at - 1] == 'E' && at < rest.size() && isDigit(rest[at]))) --at;
    rest.remove_prefix(at);
  } else if (rest.starts_with('N')) {
    rest.remove_prefix(1);
  }
  const std::string_view name = lastOfNames(rest);
  return name.empty() ? mangled : name;
}

ActivityText describeActivity(const df::ActivityPage& page, std::string_view verb) {
  ActivityText text;
  const std::uintptr_t object = page.now.object_class.load(std::memory_order_relaxed);
  const std::uintptr_t event = page.now.event_class.load(std::memory_order_relaxed);
  if (object == df::Activity::kNothing) return text;
  text.add(", while ");
  addName(page, object, text, kUnknown);
  if (event == df::Activity::kDraw) {
    text.add(" ran draw()");
  } else {
    text.add(" ");
    text.add(verb);
    text.add(" ");
    addName(page, event, text, "an event");
  }
  return text;
}

ActivityText logLine(const df::ActivityPage& page, std::size_t back) {
  constexpr std::size_t kLines = df::ActivityPage::kLines;
  ActivityText text;
  const std::uint32_t written = page.lines_written.load(std::memory_order_acquire);
  if (back >= kLines || back >= written) return text;
  const df::ActivityPage::Line& line = page.lines[(written - 1 - back) % kLines];
  char copy[sizeof line.text];
  text.addEscaped(copyText(line.text, copy));
  return text;
}

}  // namespace naiad
