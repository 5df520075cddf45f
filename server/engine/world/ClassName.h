// The name of a class as its author wrote it.
#pragma once

#include <string>
#include <typeinfo>

namespace df {

class Object;

/// "Saucer", "game::Saucer"; anonymous namespaces are left out.
std::string classNameOf(const std::type_info& type);

/// The Object's type, or where setType() was forgotten the name of its class. Not in constructors, where an
/// Object is not yet of its class.
std::string nameOf(const Object& object);

}  // namespace df
