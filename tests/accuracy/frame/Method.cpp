#include "Method.h"

#include <algorithm>
#include <deque>
#include <tuple>
#include <utility>

namespace lab {
namespace {

// Created when the first method registers. A deque, because callers keep pointers to its elements.
std::deque<Method>& registry() {
  static std::deque<Method> s_methods;
  return s_methods;
}

}  // namespace

std::vector<const Method*> Method::all() {
  std::vector<const Method*> methods;
  for (const Method& method : registry()) methods.push_back(&method);
  std::sort(methods.begin(), methods.end(), [](const Method* a, const Method* b) {
    return std::tie(a->kind, a->name) < std::tie(b->kind, b->name);
  });
  return methods;
}

RegisteredMethod::RegisteredMethod(Method method) {
  registry().push_back(std::move(method));
}

}  // namespace lab
