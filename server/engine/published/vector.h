// Includes Vector.h, for games made where file names have no upper and lower case.
#pragma once

#include "StandardHeaders.h"
#include "Vector.h"
