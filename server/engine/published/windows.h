// Includes Windows.h by its other name, because on Windows case in file names does not matter.
#pragma once

#include "Windows.h"
