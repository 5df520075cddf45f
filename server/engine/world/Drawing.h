// Draws one 8-bit character in the calling thread's current world, for shapes, lines, paths and frames.
#pragma once

#include "shared/values/Color.h"
#include "shared/values/Vector.h"

namespace df {

/// Like DM.drawCh(). A char beyond ASCII is only part of a UTF-8 character and becomes '?'. CUSTOM means the
/// default colour. Returns 0, or -1 for a position or colour out of range.
int drawCharacter(Vector world_pos, char ch, Color color);

}  // namespace df
