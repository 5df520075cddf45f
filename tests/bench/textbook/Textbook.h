// The engine of the Dragonfly book, as written from its listings: one class per file, accessors for
// everything, and a loop over all Objects for every move. It has only Objects of one character, so it cannot
// run SPRITES.
#pragma once

#include "../Engine.h"
#include "../Scene.h"

namespace textbook {

/// At most one engine may exist. `turns` is the number of Objects, evenly spaced in the list, that move in
/// each tick; for whole ticks, it is the number of all Objects.
bench::EnginePtr makeEngine(const bench::Scene& scene, int turns);

}  // namespace textbook

/// A copy of the engine, compiled as one translation unit (inlined.cpp), so that the compiler can inline
/// every getter.
namespace textbook_inlined {

bench::EnginePtr makeEngine(const bench::Scene& scene, int turns);

}  // namespace textbook_inlined
