// Settings of a trial that every mode obeys alike.
#ifndef RENDERER_SETTINGS_H
#define RENDERER_SETTINGS_H

#include <stdbool.h>

// What all modes of a comparison share. Zero: plain.
struct renderer_settings {
    bool ssao;       // ambient occlusion, half resolution
    bool taa;        // jittered projection and temporal antialiasing
    bool adjustable; // numbers may change while it runs (renderer_option_set): nothing is left out for their
                     // sake
    bool motion;     // keep motion vectors for renderer_read_motion; costs a pass
};

#endif
