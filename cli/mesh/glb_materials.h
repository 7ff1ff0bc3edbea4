/*
 * glb_materials.h: materials of glTF, with extensions.
 */
#ifndef KRS_GLB_MATERIALS_H
#define KRS_GLB_MATERIALS_H

#include <string>
#include <vector>

#include "cli/mesh/bridge.h"

#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

// Adds the name of an extension to a list that has each once.
void glb_use_extension(std::vector<std::string> &extensions, const char *name);

// Adds the materials of all parts, in their order.
void glb_add_materials(tinygltf::Model &model, const MeshParts *parts);

#endif
