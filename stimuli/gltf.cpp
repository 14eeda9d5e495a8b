// tinygltf's model as plain structs. Nothing is judged here beyond what keeps a C++ exception or a dangling
// pointer from getting out; gltf/check.c judges.
#include "stimuli/gltf/document.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#endif
#include <tiny_gltf.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace
{

using tinygltf::Value;

template <class T> T *table(size_t count)
{
    T *entries = static_cast<T *>(std::calloc(count + 1, sizeof(T)));
    if (entries == nullptr)
        throw std::bad_alloc();
    return entries;
}

template <class T> uint32_t count(const std::vector<T> &list)
{
    return static_cast<uint32_t>(list.size()); // gltf_scan bounds every list
}

// --- what tinygltf calls back ---

bool file_exists(const std::string &, void *)
{
    return true; // read_file says what is wrong
}

std::string same_path(const std::string &path, void *)
{
    return path;
}

bool read_file(std::vector<unsigned char> *out, std::string *, const std::string &path, void *user)
{
    size_t size = 0;
    uint8_t *bytes = gltf_file_read_beside(static_cast<gltf_file *>(user), path.c_str(), &size);
    if (bytes == nullptr)
        return false;
    try {
        out->assign(bytes, bytes + size);
    } catch (...) {
        std::free(bytes);
        throw;
    }
    std::free(bytes);
    return true;
}

// Keeps the file's bytes; decoding follows once sizes are known. Bytes in a view stay there: tinygltf has not
// checked that the view lies in its buffer.
bool keep_image(tinygltf::Image *image, const int, std::string *, std::string *, int, int,
                const unsigned char *bytes, int size, void *)
{
    if (image->bufferView < 0 && size > 0)
        image->image.assign(bytes, bytes + size);
    return true;
}

// --- values under extensions ---

const Value *member(const Value &object, const char *key)
{
    return object.IsObject() && object.Has(key) ? &object.Get(key) : nullptr;
}

double number(const Value &object, const char *key, double otherwise)
{
    const Value *value = member(object, key);
    return value != nullptr && value->IsNumber() ? value->GetNumberAsDouble() : otherwise;
}

int integer(const Value &object, const char *key, int otherwise)
{
    const Value *value = member(object, key);
    return value != nullptr && value->IsInt() ? value->GetNumberAsInt() : otherwise;
}

void pair(const Value &object, const char *key, double out[2])
{
    const Value *value = member(object, key);
    for (int i = 0; value != nullptr && value->ArrayLen() == 2 && i < 2; i++)
        out[i] = value->Get(i).GetNumberAsDouble();
}

void copy(const std::vector<double> &from, double *out, size_t most)
{
    for (size_t i = 0; i < from.size() && i < most; i++)
        out[i] = from[i];
}

// --- the tables ---

void take_buffers(const tinygltf::Model &model, gltf_document *d)
{
    d->buffers = table<gltf_span>(model.buffers.size());
    d->buffer_count = count(model.buffers);
    for (size_t i = 0; i < model.buffers.size(); i++)
        d->buffers[i] = {model.buffers[i].data.data(), model.buffers[i].data.size()};
    d->views = table<gltf_view>(model.bufferViews.size());
    d->view_count = count(model.bufferViews);
    for (size_t i = 0; i < model.bufferViews.size(); i++) {
        const tinygltf::BufferView &v = model.bufferViews[i];
        d->views[i] = {v.buffer, v.byteOffset, v.byteLength, v.byteStride};
    }
}

uint32_t element_width(int type)
{
    switch (type) {
    case TINYGLTF_TYPE_SCALAR:
        return 1;
    case TINYGLTF_TYPE_VEC2:
        return 2;
    case TINYGLTF_TYPE_VEC3:
        return 3;
    case TINYGLTF_TYPE_VEC4:
        return 4;
    default:
        return 0;
    }
}

void take_accessors(const tinygltf::Model &model, gltf_document *d)
{
    d->accessors = table<gltf_accessor>(model.accessors.size());
    d->accessor_count = count(model.accessors);
    for (size_t i = 0; i < model.accessors.size(); i++) {
        const tinygltf::Accessor &a = model.accessors[i];
        gltf_accessor &out = d->accessors[i];
        out.view = a.bufferView;
        out.offset = a.byteOffset;
        out.count = a.count;
        out.component = a.componentType;
        out.width = element_width(a.type);
        out.normalised = a.normalized;
        out.sparse = a.sparse.isSparse;
        if (!out.sparse) // the parser leaves the rest uninitialised
            continue;
        out.sparse_count = a.sparse.count;
        out.sparse_index_view = a.sparse.indices.bufferView;
        out.sparse_index_offset = a.sparse.indices.byteOffset;
        out.sparse_index_component = a.sparse.indices.componentType;
        out.sparse_value_view = a.sparse.values.bufferView;
        out.sparse_value_offset = a.sparse.values.byteOffset;
    }
}

void take_meshes(const tinygltf::Model &model, gltf_document *d)
{
    static const char *const names[GLTF_ATTRIBUTES] = {"POSITION",   "NORMAL",     "TANGENT",
                                                       "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"};
    size_t total = 0;
    for (const tinygltf::Mesh &mesh : model.meshes)
        total += mesh.primitives.size();
    d->primitives = table<gltf_primitive>(total);
    d->meshes = table<gltf_mesh>(model.meshes.size());
    d->mesh_count = count(model.meshes);
    for (size_t i = 0; i < model.meshes.size(); i++) {
        d->meshes[i] = {d->primitive_count, count(model.meshes[i].primitives)};
        for (const tinygltf::Primitive &p : model.meshes[i].primitives) {
            gltf_primitive &out = d->primitives[d->primitive_count++];
            for (int k = 0; k < GLTF_ATTRIBUTES; k++) {
                auto at = p.attributes.find(names[k]);
                out.attribute[k] = at != p.attributes.end() ? at->second : -1;
            }
            out.indices = p.indices;
            out.material = p.material;
            out.mode = p.mode;
            out.morph = !p.targets.empty();
        }
    }
}

template <class T> gltf_texture_use texture_use(const T &info)
{
    gltf_texture_use use = {info.index, info.texCoord, {0.0, 0.0}, 0.0, {1.0, 1.0}};
    auto at = info.extensions.find("KHR_texture_transform");
    if (at != info.extensions.end()) {
        pair(at->second, "offset", use.offset);
        pair(at->second, "scale", use.scale);
        use.rotation = number(at->second, "rotation", 0.0);
        use.uv_set = integer(at->second, "texCoord", use.uv_set);
    }
    return use;
}

void take_material(const tinygltf::Material &m, gltf_material *out)
{
    const tinygltf::PbrMetallicRoughness &pbr = m.pbrMetallicRoughness;
    out->name = m.name.c_str();
    copy(pbr.baseColorFactor, out->base_colour, 4);
    copy(m.emissiveFactor, out->emissive, 3);
    out->metallic = pbr.metallicFactor;
    out->roughness = pbr.roughnessFactor;
    out->normal_scale = m.normalTexture.scale;
    out->occlusion_strength = m.occlusionTexture.strength;
    out->alpha_cutoff = m.alphaCutoff;
    out->mask = m.alphaMode == "MASK";
    out->blend = m.alphaMode == "BLEND";
    out->double_sided = m.doubleSided;
    out->use[0] = texture_use(pbr.baseColorTexture);
    out->use[1] = texture_use(pbr.metallicRoughnessTexture);
    out->use[2] = texture_use(m.normalTexture);
    out->use[3] = texture_use(m.occlusionTexture);
    out->use[4] = texture_use(m.emissiveTexture);
    for (const auto &extension : m.extensions) {
        double strength = number(extension.second, "emissiveStrength", 1.0);
        if (extension.first != "KHR_materials_emissive_strength")
            out->extended = true;
        else
            for (double &channel : out->emissive)
                channel *= strength;
    }
}

void take_materials(const tinygltf::Model &model, gltf_document *d)
{
    d->materials = table<gltf_material>(model.materials.size());
    d->material_count = count(model.materials);
    for (size_t i = 0; i < model.materials.size(); i++)
        take_material(model.materials[i], &d->materials[i]);
    d->textures = table<gltf_texture>(model.textures.size());
    d->texture_count = count(model.textures);
    for (size_t i = 0; i < model.textures.size(); i++)
        d->textures[i] = {model.textures[i].source, model.textures[i].sampler};
    d->samplers = table<gltf_sampler>(model.samplers.size());
    d->sampler_count = count(model.samplers);
    for (size_t i = 0; i < model.samplers.size(); i++)
        d->samplers[i] = {model.samplers[i].magFilter, model.samplers[i].wrapS, model.samplers[i].wrapT};
    d->images = table<gltf_image>(model.images.size());
    d->image_count = count(model.images);
    for (size_t i = 0; i < model.images.size(); i++) {
        const tinygltf::Image &image = model.images[i];
        d->images[i] = {{image.image.data(), image.image.size()}, image.bufferView, image.uri.c_str()};
    }
}

void take_node(const tinygltf::Node &n, gltf_document *d, gltf_node *out)
{
    out->mesh = n.mesh;
    out->camera = n.camera;
    out->skin = n.skin;
    out->light = -1;
    auto light = n.extensions.find("KHR_lights_punctual");
    if (light != n.extensions.end())
        out->light = integer(light->second, "light", -1);
    out->first_child = d->child_count;
    out->child_count = count(n.children);
    for (int child : n.children)
        d->children[d->child_count++] = child;
    out->matrix_count = count(n.matrix);
    out->translation_count = count(n.translation);
    out->rotation_count = count(n.rotation);
    out->scale_count = count(n.scale);
    copy(n.matrix, out->matrix, 16);
    copy(n.translation, out->translation, 3);
    copy(n.rotation, out->rotation, 4);
    copy(n.scale, out->scale, 3);
}

void take_nodes(const tinygltf::Model &model, gltf_document *d)
{
    size_t children = 0, roots = 0;
    for (const tinygltf::Node &node : model.nodes)
        children += node.children.size();
    for (const tinygltf::Scene &scene : model.scenes)
        roots += scene.nodes.size();
    d->children = table<int32_t>(children);
    d->nodes = table<gltf_node>(model.nodes.size());
    d->node_count = count(model.nodes);
    for (size_t i = 0; i < model.nodes.size(); i++)
        take_node(model.nodes[i], d, &d->nodes[i]);
    d->roots = table<int32_t>(roots);
    d->scenes = table<gltf_root_list>(model.scenes.size());
    d->scene_count = count(model.scenes);
    for (size_t i = 0; i < model.scenes.size(); i++) {
        d->scenes[i] = {d->root_count, count(model.scenes[i].nodes)};
        for (int root : model.scenes[i].nodes)
            d->roots[d->root_count++] = root;
    }
    d->default_scene = model.defaultScene;
    d->skin_count = count(model.skins);
    d->camera_count = count(model.cameras);
}

void take_animation(const tinygltf::Model &model, gltf_document *d)
{
    static const tinygltf::Animation none;
    const tinygltf::Animation &first = model.animations.empty() ? none : model.animations[0];
    d->animation_count = count(model.animations);
    d->channels = table<gltf_channel>(first.channels.size());
    d->channel_count = count(first.channels);
    for (size_t i = 0; i < first.channels.size(); i++) {
        const tinygltf::AnimationChannel &c = first.channels[i];
        d->channels[i] = {c.sampler, c.target_node, c.target_path.c_str()};
    }
    d->animation_samplers = table<gltf_animation_sampler>(first.samplers.size());
    d->animation_sampler_count = count(first.samplers);
    for (size_t i = 0; i < first.samplers.size(); i++) {
        const tinygltf::AnimationSampler &s = first.samplers[i];
        d->animation_samplers[i] = {s.input, s.output, s.interpolation.c_str()};
    }
}

void take_lights(const tinygltf::Model &model, gltf_document *d)
{
    d->lights = table<gltf_light>(model.lights.size());
    d->light_count = count(model.lights);
    for (size_t i = 0; i < model.lights.size(); i++) {
        const tinygltf::Light &l = model.lights[i];
        d->lights[i] = {l.type.c_str(), {1.0, 1.0, 1.0},       l.intensity,
                        l.range,        l.spot.innerConeAngle, l.spot.outerConeAngle};
        copy(l.color, d->lights[i].colour, 3);
    }
}

const char **take_texts(const std::vector<std::string> &list)
{
    const char **texts = table<const char *>(list.size());
    for (size_t i = 0; i < list.size(); i++)
        texts[i] = list[i].c_str();
    return texts;
}

void take_all(const tinygltf::Model &model, gltf_document *d)
{
    take_buffers(model, d);
    take_accessors(model, d);
    take_meshes(model, d);
    take_materials(model, d);
    take_nodes(model, d);
    take_animation(model, d);
    take_lights(model, d);
    d->extensions_used = take_texts(model.extensionsUsed);
    d->extension_used_count = count(model.extensionsUsed);
    d->extensions_required = take_texts(model.extensionsRequired);
    d->extension_required_count = count(model.extensionsRequired);
}

// --- errors ---

// tinygltf 2.7 wants what glTF leaves optional in a skin; we read neither.
void forgive_skins(std::string *complaint)
{
    static const std::string line = "'inverseBindMatrices' property is missing in Skin.\n";
    for (size_t at; (at = complaint->find(line)) != std::string::npos;)
        complaint->erase(at, line.size());
}

// The parser's first complaint on one line. "... at line 3, column 7: what" becomes "3:7: what".
void write_complaint(const std::string &complaint, char *error, size_t error_size)
{
    std::string text = complaint.substr(0, complaint.find('\n'));
    if (text.find("Failed to decode 'uri' : data:") == 0) // would go on with the data
        text = "buffers: a data URI is not base64 of byteLength bytes";
    size_t line = 0, column = 0, at = text.find("at line ");
    size_t rest = text.find(": ", at == std::string::npos ? 0 : at);
    if (at != std::string::npos && rest != std::string::npos &&
        std::sscanf(text.c_str() + at, "at line %zu, column %zu", &line, &column) == 2)
        text = std::to_string(line) + ":" + std::to_string(column) + text.substr(rest);
    for (char &c : text)
        if (static_cast<unsigned char>(c) < 32)
            c = ' ';
    std::snprintf(error, error_size, "%s", text.empty() ? "the glTF parser gave up" : text.c_str());
}

bool parse_model(gltf_file *file, tinygltf::Model *model, char *error, size_t error_size)
{
    tinygltf::TinyGLTF loader;
    std::string complaint, warning;
    loader.SetImageLoader(keep_image, nullptr);
    loader.SetFsCallbacks({file_exists, same_path, read_file, nullptr, file});
    unsigned size = static_cast<unsigned>(file->size);
    bool ok = file->binary ? loader.LoadBinaryFromMemory(model, &complaint, &warning, file->bytes, size)
                           : loader.LoadASCIIFromString(model, &complaint, &warning,
                                                        reinterpret_cast<const char *>(file->bytes), size, "");
    forgive_skins(&complaint);
    // The parser drops what it cannot read and says so only in its complaint.
    if (ok && complaint.empty())
        return true;
    if (file->problem[0] != '\0')
        complaint = file->problem;
    write_complaint(complaint, error, error_size);
    return false;
}

} // namespace

struct gltf_document *gltf_parse(struct gltf_file *file, char *error, size_t error_size)
{
    gltf_document *document = static_cast<gltf_document *>(std::calloc(1, sizeof(gltf_document)));
    tinygltf::Model *model = nullptr;
    bool ok = false;
    try {
        model = new tinygltf::Model();
        ok = document != nullptr && parse_model(file, model, error, error_size);
        if (ok) {
            take_all(*model, document);
            document->parser = model;
            return document;
        }
    } catch (const std::bad_alloc &) {
        std::snprintf(error, error_size, "out of memory");
    } catch (const std::exception &e) {
        write_complaint(e.what(), error, error_size);
    }
    if (document != nullptr)
        document->parser = model;
    else
        delete model;
    gltf_document_destroy(document);
    return nullptr;
}

void gltf_document_destroy(struct gltf_document *d)
{
    if (d == nullptr)
        return;
    std::free(d->buffers);
    std::free(d->views);
    std::free(d->accessors);
    std::free(d->primitives);
    std::free(d->meshes);
    std::free(d->materials);
    std::free(d->textures);
    std::free(d->samplers);
    std::free(d->images);
    std::free(d->nodes);
    std::free(d->children);
    std::free(d->scenes);
    std::free(d->roots);
    std::free(d->channels);
    std::free(d->animation_samplers);
    std::free(d->lights);
    std::free(d->extensions_used);
    std::free(d->extensions_required);
    delete static_cast<tinygltf::Model *>(d->parser);
    std::free(d);
}
