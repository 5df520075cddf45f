// Tells an Object that called pathTo() how the search ended. It is sent before pathTo() returns; no interest
// needs to be registered.
#pragma once

#include <utility>

#include "Event.h"
#include "Path.h"

namespace df {

/// Type of EventPath, which is sent without registration to the Object that asked for a path.
inline const EventType PATH_EVENT("df-path");

/// Results of a search.
enum SearchResult {
  NOT_FOUND,
  INCOMPLETE,
  FOUND,
};

class EventPath : public Event {
 public:
  EventPath() : Event(&PATH_EVENT) {}
  /// Makes an event with result FOUND and this path.
  explicit EventPath(Path path) : Event(&PATH_EVENT), m_result(FOUND), m_path(std::move(path)) {}

  /// Result of the search.
  void setResult(SearchResult new_result) { m_result = new_result; }
  SearchResult getResult() const { return m_result; }
  /// The path that was found; empty if none was.
  void setPath(Path new_path) { m_path = std::move(new_path); }
  const Path& getPath() const { return m_path; }

 private:
  SearchResult m_result = NOT_FOUND;
  Path m_path;
};

}  // namespace df
