// Reads an ActivityPage after a crash or during a hang: what the game was doing, for lines of the log.
//
// All that it does is async-signal-safe: it allocates nothing, and follows no pointer of the page. The page
// may be a stranger's: whatever is in it, the text is short, of printable ASCII, and stays in its line.
#pragma once

#include <cstddef>
#include <string_view>

#include "engine/world/ActivityPage.h"

namespace naiad {

/// A text in memory of its own; what does not fit is cut off.
class ActivityText {
 public:
  std::string_view view() const { return {m_text, m_size}; }
  bool empty() const { return m_size == 0; }
  void add(std::string_view text);
  /// Control characters and those beyond ASCII as \xNN.
  void addEscaped(std::string_view text);

 private:
  char m_text[512];
  std::size_t m_size = 0;
};

/// The class's own name, of "N2df9EventStepE" as of "9EventStep"; all of it where it is something else.
std::string_view classInMangled(std::string_view mangled);

/// ", while Ship handled EventStep" (`verb`: "handled"), ", while Ship ran draw()"; empty if no handler runs.
ActivityText describeActivity(const df::ActivityPage& page, std::string_view verb);

/// The last lines of the game's log, oldest first: `back` counts from the newest, which is 0. Empty if there
/// is none.
ActivityText logLine(const df::ActivityPage& page, std::size_t back);

}  // namespace naiad
