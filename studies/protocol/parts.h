// The parts of a protocol file, each read by one function. Inside this room only.
#ifndef STUDIES_PROTOCOL_PARTS_H
#define STUDIES_PROTOCOL_PARTS_H

#include "studies/protocol/read.h"

// settings.c
void settings_defaults(const struct catalogue *catalogue, struct protocol_settings *out);
// Overlays what a `settings` mapping gives on what is inherited; NULL changes nothing.
bool settings_read(struct reader *reader, const struct yaml_node *node, struct protocol_settings *settings);

// options.c
bool scenes_read(struct reader *reader, const struct yaml_node *root);
bool options_read(struct reader *reader, const struct yaml_node *root);
// One parameter's value: a number within its range or one of its words.
bool parameter_read(struct reader *reader, const struct yaml_node *node,
                    const struct catalogue_parameter *parameter, const char *mode, double *out);
// Index of a parameter that `word` names; false after an error placed at the node, or at its key.
bool parameter_find(struct reader *reader, const struct yaml_node *node, bool at_key, const char *word,
                    uint32_t mode, uint32_t *out);
bool option_find(struct reader *reader, const struct yaml_node *node, bool at_key, const char *word,
                 uint32_t *out);
bool scene_find(struct reader *reader, const struct yaml_node *node, uint32_t *out);

// people.c
bool questions_read(struct reader *reader, const struct yaml_node *root);
bool consent_read(struct reader *reader, const struct yaml_node *root);
bool participant_read(struct reader *reader, const struct yaml_node *root);
bool analysis_read(struct reader *reader, const struct yaml_node *root);

// blocks.c
bool blocks_read(struct reader *reader, const struct yaml_node *root, const struct protocol_settings *study);

// design.c
bool factors_read(struct reader *reader, const struct yaml_node *node, struct protocol_block *block);
bool trials_read(struct reader *reader, const struct yaml_node *node, struct protocol_block *block);

#endif
