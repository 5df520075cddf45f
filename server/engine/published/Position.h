// Position: the name of Vector in published engines up to 4.1, where its coordinates were int.
#pragma once

#include "Vector.h"

namespace df {

using Position = Vector;

}  // namespace df
