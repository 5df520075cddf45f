#include "engine/world/ActivityPage.h"

#include <algorithm>

namespace df {

void ActivityPage::addName(std::uintptr_t id, const char* p_mangled) {
  for (std::size_t tries = 0, i = id / sizeof id; tries < kNames; ++tries, ++i) {
    Name& name = names[i % kNames];
    const std::uintptr_t there = name.id.load(std::memory_order_relaxed);
    if (there == id) return;
    if (there != 0) continue;
    std::strncpy(name.text, p_mangled, sizeof name.text);
    name.id.store(id, std::memory_order_release);
    return;
  }
}

void ActivityPage::addLine(std::string_view line) {
  const std::uint32_t written = lines_written.load(std::memory_order_relaxed);
  Line& at = lines[written % kLines];
  const std::size_t size = std::min(line.size(), sizeof at.text);
  std::memcpy(at.text, line.data(), size);
  std::memset(at.text + size, 0, sizeof at.text - size);
  lines_written.store(written + 1, std::memory_order_release);
}

}  // namespace df
