#include "EventLog.h"

#include <sstream>

namespace oracle {

std::string toString(const Entry& entry) {
  std::ostringstream text;
  text.precision(17);
  const auto position = [&] {
    text << '(' << df::toCells(entry.where.x) << ", " << df::toCells(entry.where.y) << ')';
  };
  switch (entry.what) {
    case Happening::STEP:
      text << "step to " << entry.receiver;
      break;
    case Happening::COLLISION:
      text << "collision to " << entry.receiver << ": " << entry.object1 << " onto " << entry.object2
           << " at ";
      position();
      break;
    case Happening::OUT:
      text << "out to " << entry.receiver;
      break;
    case Happening::MOVED:
      text << "moveObject of " << entry.receiver << " to ";
      position();
      text << " returned " << entry.result;
      break;
    case Happening::DESTROYED:
      text << "destructor of " << entry.receiver;
      break;
  }
  return text.str();
}

}  // namespace oracle
