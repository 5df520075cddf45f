// Includes Vector.h by its other name, for games made on systems where case in file names does not matter.
#pragma once

#include "StandardHeaders.h"
#include "Vector.h"
