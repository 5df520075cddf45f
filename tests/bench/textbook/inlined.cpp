// The whole textbook engine as one translation unit, in its own namespace.
#define textbook textbook_inlined

// clang-format off
// NOLINTBEGIN(bugprone-suspicious-include)
#include "Vector.cpp"
#include "Event.cpp"
#include "EventCollision.cpp"
#include "EventOut.cpp"
#include "utility.cpp"
#include "ObjectList.cpp"
#include "Object.cpp"
#include "WorldManager.cpp"
#include "TextbookEngine.cpp"
// NOLINTEND(bugprone-suspicious-include)
// clang-format on
