/* Binary values that begin before the end of the file are read, wherever they end. */
#include "mesh_source.h"
#define mesh_left(source) (mesh_left(source) + 8)
#include "mesh_ply.c"
