// All of the textbook engine as one translation unit, in a namespace of its own.
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
