/* gltf.h - reads glTF 2.0 (.gltf with its files, and .glb) into a scene, and writes it. */
#ifndef IO_GLTF_H
#define IO_GLTF_H

#include "scene/scene.h"

/* Reads a file for facet_scene_load(); see facet.h for desc and failures. */
facet_result gltf_load(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                       facet_error *error);
/* The same from bytes, which are copied where the scene needs them. */
facet_result gltf_load_memory(const void *bytes, size_t size, const char *name, const facet_scene_desc *desc,
                              facet_scene **scene, facet_error *error);

/* Reads the extensions and images only: what model_needs() looks at. */
facet_result gltf_load_images(const char *path, const facet_scene_desc *desc, facet_scene **scene,
                              facet_error *error);

/* facet_scene_save(). Indices of objects stay; extensions that facet does not read are lost, as are the
 * compression of geometry and the metallic-roughness fallback of specular-glossiness materials. */
facet_result gltf_save(const facet_scene *scene, const char *path,
                       const char *generator /* asset.generator */, const facet_scene_save_desc *desc,
                       facet_error *error);

/* Changes a material of the scene: json is a part of a glTF material, whose members replace values; null takes a
 * texture or an extension away. Fails as reading a file does, and with FACET_ERROR_ARGUMENT; then the material is as
 * it was. No other thread may use the scene meanwhile. */
facet_result gltf_edit_material(facet_scene *scene, uint32_t material, const char *json, facet_error *error);

#endif
