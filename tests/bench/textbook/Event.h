// Listing 4.51 of the Dragonfly book.
#pragma once

#include <string>

namespace textbook {

const std::string UNDEFINED_EVENT = "df::undefined";

class Event {
 private:
  std::string m_event_type;  // Holds event type.

 public:
  Event();
  virtual ~Event();

  void setType(std::string new_type);
  std::string getType() const;
};

}  // namespace textbook
