// The book's engine as written from its listings: one class per file, accessors for everything, and a loop
// over all Objects for every move. It knows only single characters, so it cannot run SPRITES.
#pragma once

#include "../Engine.h"
#include "../Scene.h"

namespace textbook {

/// At most one may exist. `turns` is the number of Objects, evenly spaced in the list, that take a turn per
/// tick; all of the scene's for a whole tick.
bench::EnginePtr makeEngine(const bench::Scene& scene, int turns);

}  // namespace textbook

/// A copy compiled as one translation unit, so that the compiler can inline every getter: inlined.cpp.
namespace textbook_inlined {

bench::EnginePtr makeEngine(const bench::Scene& scene, int turns);

}  // namespace textbook_inlined
