// Access to a private data member of a LIGGGHTS class without changing LIGGGHTS.
//
// An explicit template instantiation may name private members (C++20 [temp.spec.general]/6); the
// friend function it defines hands the pointer to member out. Used as
//   struct FixMap {
//     using Member = std::map<...>* LAMMPS_NS::Modify::*;
//     friend Member private_member(FixMap);
//   };
//   template struct gasgrain::plugins::GrantAccess<FixMap, &LAMMPS_NS::Modify::fix_map>;
// after which object.*private_member(FixMap()) is the member. The tag must be a member of this
// namespace itself (not of an unnamed one), where the friend function is defined.
#pragma once

namespace gasgrain::plugins {

template <class Tag, typename Tag::Member member>
struct GrantAccess {
  friend typename Tag::Member private_member(Tag) { return member; }
};

}  // namespace gasgrain::plugins
