// The command `coarsegraining l1 [l2 ...] [model_check error|warn]`.
//
// Stock LIGGGHTS contains coarse graining in full (class Force) except for this command. It sets
// the ratio l of each atom type and how stock models that do not scale react. The class has its
// name and namespace because LIGGGHTS declares it a friend of Force. What l changes:
// docs/coarse_graining.md.
#ifdef COMMAND_CLASS
CommandStyle(coarsegraining, Coarsegraining)
#else
// no #pragma once: the same file is read again under *_CLASS
#ifndef GASGRAIN_COARSEGRAINING_H
#define GASGRAIN_COARSEGRAINING_H

#include <pointers.h>

namespace LAMMPS_NS {

class Coarsegraining : protected Pointers {
 public:
  explicit Coarsegraining(LAMMPS* liggghts) : Pointers(liggghts) {}
  void command(int argument_count, char** arguments);

 private:
  void refuse_if_late() const;
};

}  // namespace LAMMPS_NS
#endif
#endif
