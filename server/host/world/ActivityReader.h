// Reads an ActivityPage after a crash or during a hang, to log what the game was doing.
//
// All functions are async-signal-safe: they allocate nothing, and follow no pointer of the page. A malicious
// game may write anything to the page, but the text is always short, printable ASCII without line breaks.
#pragma once

#include <cstddef>
#include <string_view>

#include "engine/world/ActivityPage.h"

namespace naiad {

/// A text in a fixed buffer, truncated to its size.
class ActivityText {
 public:
  std::string_view view() const { return {m_text, m_size}; }
  bool empty() const { return m_size == 0; }
  void add(std::string_view text);
  /// Adds a text, with control and non-ASCII characters as \xNN.
  void addEscaped(std::string_view text);

 private:
  char m_text[512];
  std::size_t m_size = 0;
};

/// Returns the class's own name, without namespaces or an enclosing function: "EventStep" of
/// "N2df9EventStepE" or "9EventStep". Other forms stay whole.
std::string_view classInMangled(std::string_view mangled);

/// Returns ", while Ship handled EventStep" (`verb`: "handled"), ", while Ship ran draw()", or "" between
/// handlers.
ActivityText describeActivity(const df::ActivityPage& page, std::string_view verb);

/// Returns one of the last lines of the game's log. `back` counts from the newest line, which is 0. Empty if
/// the page does not have that many lines.
ActivityText logLine(const df::ActivityPage& page, std::size_t back);

}  // namespace naiad
