#include "EventLog.h"

#include <algorithm>
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

std::string firstDifference(const EventLog& engine, const EventLog& oracle) {
  const auto& a = engine.entries();
  const auto& b = oracle.entries();
  std::size_t i = 0;
  while (i < a.size() && i < b.size() && a[i] == b[i]) ++i;
  if (i == a.size() && i == b.size()) return {};

  std::ostringstream text;
  for (std::size_t k = i - std::min<std::size_t>(i, 8); k < i; ++k)
    text << "  both    " << toString(a[k]) << '\n';
  text << "  engine  " << (i < a.size() ? toString(a[i]) : "nothing more") << '\n';
  text << "  oracle  " << (i < b.size() ? toString(b[i]) : "nothing more") << '\n';
  return text.str();
}

}  // namespace oracle
