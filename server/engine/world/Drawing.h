// One character of the 8-bit kind in the calling thread's current world: what shapes, lines, paths and frames
// draw.
#pragma once

#include "shared/values/Color.h"
#include "shared/values/Vector.h"

namespace df {

/// As DM.drawCh(): a char beyond ASCII is a piece of some encoding, not a character, and becomes '?'; CUSTOM
/// is the default colour. Return 0, or -1 for a position or colour out of range.
int drawCharacter(Vector world_pos, char ch, Color color);

}  // namespace df
