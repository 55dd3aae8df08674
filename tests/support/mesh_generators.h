// mesh_generators: the product's generated meshes, under the name that tests know them by.
#pragma once
#include "contact/mesh/generated_meshes.h"
