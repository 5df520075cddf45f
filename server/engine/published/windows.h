// Includes Windows.h by its other name: on Windows file names have no upper and lower case.
#pragma once

#include "Windows.h"
