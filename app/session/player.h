// Unpacks a recording ahead of the screen: a thread for each eye fills a ring of buffers, so that whoever shows
// a frame finds it ready.
//
// Use: player_create with the ring's buffers -> player_load -> player_take per frame shown -> player_destroy
// before the buffers go. The caller's thread calls; the buffer of the frame taken last is left alone, and so
// are those after it once they are filled. Does not: upload, keep time.
#ifndef APP_SESSION_PLAYER_H
#define APP_SESSION_PLAYER_H

#include "app/session/recording.h"

enum { PLAYER_BUFFERS = 6 }; // 67 ms at 90 Hz: a decoding thread may lose that long to another program

struct player;
// buffers: both eyes' pictures each, left then right; borrowed, only written to. NULL: out of memory or
// threads.
struct player *player_create(uint8_t *const buffers[PLAYER_BUFFERS], uint32_t width, uint32_t height);
void player_destroy(struct player *player); // NULL is fine
// From its first frame on; borrowed until the next load. NULL: none.
void player_load(struct player *player, const struct recording *recording);
// The buffer that holds a frame of the recording; -1: it is not there yet (never with `wait`, unless the
// recording is damaged). An earlier frame than the one before starts anew from there.
int player_take(struct player *player, uint32_t frame, bool wait);

#endif
