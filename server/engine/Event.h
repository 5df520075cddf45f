// What an Object is told (book, Listing 4.51). An Event is a container: a type name and, in derived
// classes, a few values. Games derive their own and send them with WM.onEvent().
#pragma once

#include <string>
#include <utility>

namespace df {

/// Type of an Event nobody has named.
inline const std::string UNDEFINED_EVENT = "df-undefined";

class Event {
 public:
  /// An event of type UNDEFINED_EVENT.
  Event() = default;
  virtual ~Event() = default;

  /// The name by which Objects register interest and tell events apart. Names that begin with "df-"
  /// belong to the engine.
  void setType(std::string new_type) { m_type = std::move(new_type); }
  const std::string& getType() const { return m_type; }

 private:
  std::string m_type = UNDEFINED_EVENT;
};

}  // namespace df
