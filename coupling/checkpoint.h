// The whole state of a world in an archive: a run that goes on from it is bitwise the run that
// never stopped. Structures must have been built (from the scene) before their state is read.
#pragma once
#include "coupling/archive.h"
#include "coupling/world.h"

namespace trackbed::coupling {

void write_world(ArchiveWriter&, World&);

/// Shapes, bodies and contacts; replaces what the world holds.
void read_world(ArchiveReader&, World&);

/// States of the surfaces and their structures, in the order they were written. Throws InputError
/// when the archive holds other surfaces than the world.
void read_surfaces(ArchiveReader&, World&);

}  // namespace trackbed::coupling
