// Sent to an Object that called pathTo(): how the search ended. It comes at once, before pathTo()
// returns; no interest needs to be registered.
#pragma once

#include <utility>

#include "Event.h"
#include "Path.h"

namespace df {

/// Comes without being registered for, to the Object that asked for a path.
inline const EventType PATH_EVENT("df-path");

/// How a search ended.
enum SearchResult {
  NOT_FOUND,
  INCOMPLETE,
  FOUND,
};

class EventPath : public Event {
 public:
  EventPath() : Event(&PATH_EVENT) {}
  /// With the path that was found; empty for none.
  explicit EventPath(Path path) : Event(&PATH_EVENT), m_result(FOUND), m_path(std::move(path)) {}

  /// How the search ended.
  void setResult(SearchResult new_result) { m_result = new_result; }
  SearchResult getResult() const { return m_result; }
  /// What it found.
  void setPath(Path new_path) { m_path = std::move(new_path); }
  const Path& getPath() const { return m_path; }

 private:
  SearchResult m_result = NOT_FOUND;
  Path m_path;
};

}  // namespace df
