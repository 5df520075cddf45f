// LogManager as games include it: the published engine's header brings utility.h along.
#pragma once

#include "detail/LogManager.h"
#include "utility.h"
