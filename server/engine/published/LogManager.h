// LogManager as games include it: with utility.h, as in the published engine.
#pragma once

#include "detail/LogManager.h"
#include "utility.h"
