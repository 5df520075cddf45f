// Names of published engines up to 4.1: Position is Vector, whose coordinates were int, and two attributes.
#pragma once

#include "ObjectAttributes.h"
#include "Vector.h"

namespace df {

using Position = Vector;

#if !defined(DF_SCOPED_ENUMS)
const ObjectAttribute POS = ObjectAttribute::POSITION;
const ObjectAttribute VELOCITY =
    ObjectAttribute(unsigned(ObjectAttribute::SPEED) | unsigned(ObjectAttribute::DIRECTION));
#endif

}  // namespace df
