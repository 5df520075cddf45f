// For games that include the graphics library SFML by themselves: what stands in for it.
#pragma once

#include "../../Sfml.h"
