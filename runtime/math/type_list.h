// Lists of types, from which tables of kernels are made.
#pragma once

namespace loam {

template <class... Types> struct TypeList {};

template <class... Lists> struct Concatenate;
template <> struct Concatenate<> { using Type = TypeList<>; };
template <class... A> struct Concatenate<TypeList<A...>> { using Type = TypeList<A...>; };
template <class... A, class... B, class... Rest> struct Concatenate<TypeList<A...>, TypeList<B...>, Rest...> {
  using Type = typename Concatenate<TypeList<A..., B...>, Rest...>::Type;
};

template <class Type, class List> struct IndexOf;
template <class Type, class... Rest> struct IndexOf<Type, TypeList<Type, Rest...>> { static constexpr int value = 0; };
template <class Type, class First, class... Rest> struct IndexOf<Type, TypeList<First, Rest...>> {
  static constexpr int value = 1 + IndexOf<Type, TypeList<Rest...>>::value;
};

template <class List> struct Length;
template <class... Types> struct Length<TypeList<Types...>> { static constexpr int value = sizeof...(Types); };

} // namespace loam
