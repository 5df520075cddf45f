// The book's engine as people write it who follow its listings: one class per file, everything behind a
// function call, a loop over all Objects for every move. It knows single characters only, so it cannot run
// SPRITES.
#pragma once

#include "../Engine.h"
#include "../Scene.h"

namespace textbook {

/// At most one at a time. `turns`: how many Objects, at equal distances in the list, take a turn per tick;
/// all of the scene's for a whole tick.
bench::EnginePtr makeEngine(const bench::Scene& scene, int turns);

}  // namespace textbook

/// The same source as one translation unit, so that the compiler sees through every getter: inlined.cpp.
namespace textbook_inlined {

bench::EnginePtr makeEngine(const bench::Scene& scene, int turns);

}  // namespace textbook_inlined
