#include "Method.h"

#include <algorithm>
#include <deque>
#include <tuple>
#include <utility>

namespace lab {
namespace {

// Created by whichever method registers first. A deque, because others keep pointers into it.
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
