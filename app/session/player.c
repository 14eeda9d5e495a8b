#include "app/session/player.h"

#include "app/session/pack.h"

#include <pthread.h>
#include <stdlib.h>

struct player {
    pthread_mutex_t lock;
    pthread_cond_t work, done; // for the threads; for who waits
    pthread_t threads[EYES];
    int thread_count;
    uint8_t *buffers[PLAYER_BUFFERS]; // borrowed
    uint8_t *scratch[EYES];
    size_t pixels;
    // Under the lock:
    const struct recording *recording;
    uint32_t first;      // the frame taken last: the oldest whose buffer is kept
    uint32_t next[EYES]; // each thread's next frame: those from `first` to before it are ready
    bool busy[EYES];     // reads the recording just now
    bool damaged, ended;
    uint64_t turn; // counts up where `first` goes back: what is being unpacked then is not wanted
};

struct worker {
    struct player *player;
    int eye;
};

static bool has_work(const struct player *player, int eye)
{
    return player->recording && !player->damaged && player->next[eye] < player->recording->count &&
           player->next[eye] < player->first + PLAYER_BUFFERS;
}

// With the lock held, which is let go while a picture is unpacked.
static void unpack_next(struct player *player, int eye)
{
    uint32_t frame = player->next[eye];
    uint64_t turn = player->turn;
    const struct recording_frame *packed = &player->recording->frames[frame];
    uint8_t *out = player->buffers[frame % PLAYER_BUFFERS] + (size_t)eye * 4 * player->pixels;
    player->busy[eye] = true;
    pthread_mutex_unlock(&player->lock);
    bool good = unpack(packed->packed[eye], packed->size[eye], player->pixels, player->scratch[eye], out);
    pthread_mutex_lock(&player->lock);
    player->busy[eye] = false;
    if (good && turn == player->turn && player->next[eye] == frame)
        player->next[eye] = frame + 1;
    player->damaged = player->damaged || !good;
    pthread_cond_broadcast(&player->done);
}

static void *run(void *user)
{
    struct worker worker = *(struct worker *)user;
    struct player *player = worker.player;
    free(user);
    pthread_mutex_lock(&player->lock);
    while (!player->ended) {
        if (has_work(player, worker.eye))
            unpack_next(player, worker.eye);
        else
            pthread_cond_wait(&player->work, &player->lock);
    }
    pthread_mutex_unlock(&player->lock);
    return NULL;
}

static bool start(struct player *player, int eye)
{
    struct worker *worker = malloc(sizeof *worker);
    if (!worker)
        return false;
    *worker = (struct worker){player, eye};
    if (pthread_create(&player->threads[eye], NULL, run, worker) == 0) {
        player->thread_count++;
        return true;
    }
    free(worker);
    return false;
}

struct player *player_create(uint8_t *const buffers[PLAYER_BUFFERS], uint32_t width, uint32_t height)
{
    struct player *player = calloc(1, sizeof *player);
    if (!player)
        return NULL;
    player->pixels = (size_t)width * height;
    for (int i = 0; i < PLAYER_BUFFERS; i++)
        player->buffers[i] = buffers[i];
    pthread_mutex_init(&player->lock, NULL);
    pthread_cond_init(&player->work, NULL);
    pthread_cond_init(&player->done, NULL);
    bool good = true;
    for (int eye = 0; good && eye < EYES; eye++) {
        player->scratch[eye] = malloc(pack_scratch(player->pixels));
        good = player->scratch[eye] && start(player, eye);
    }
    if (good)
        return player;
    player_destroy(player);
    return NULL;
}

void player_destroy(struct player *player)
{
    if (!player)
        return;
    pthread_mutex_lock(&player->lock);
    player->ended = true;
    pthread_cond_broadcast(&player->work);
    pthread_mutex_unlock(&player->lock);
    for (int i = 0; i < player->thread_count; i++)
        pthread_join(player->threads[i], NULL);
    pthread_cond_destroy(&player->work);
    pthread_cond_destroy(&player->done);
    pthread_mutex_destroy(&player->lock);
    for (int eye = 0; eye < EYES; eye++)
        free(player->scratch[eye]);
    free(player);
}

static void begin_at(struct player *player, uint32_t frame)
{
    player->turn++;
    player->first = frame;
    for (int eye = 0; eye < EYES; eye++)
        player->next[eye] = frame;
}

void player_load(struct player *player, const struct recording *recording)
{
    pthread_mutex_lock(&player->lock);
    player->recording = NULL;
    while (player->busy[EYE_LEFT] || player->busy[EYE_RIGHT]) // they may read what the caller frees next
        pthread_cond_wait(&player->done, &player->lock);
    player->recording = recording;
    player->damaged = false;
    begin_at(player, 0);
    pthread_cond_broadcast(&player->work);
    pthread_mutex_unlock(&player->lock);
}

// A jump ahead leaves out what was skipped.
static void go_to(struct player *player, uint32_t frame)
{
    if (frame < player->first)
        begin_at(player, frame);
    player->first = frame;
    for (int eye = 0; eye < EYES; eye++)
        if (player->next[eye] < frame)
            player->next[eye] = frame;
    pthread_cond_broadcast(&player->work);
}

static bool is_ready(const struct player *player, uint32_t frame)
{
    return player->next[EYE_LEFT] > frame && player->next[EYE_RIGHT] > frame;
}

int player_take(struct player *player, uint32_t frame, bool wait)
{
    pthread_mutex_lock(&player->lock);
    bool known = player->recording && frame < player->recording->count;
    if (known)
        go_to(player, frame);
    while (known && wait && !player->damaged && !is_ready(player, frame))
        pthread_cond_wait(&player->done, &player->lock);
    bool ready = known && is_ready(player, frame);
    pthread_mutex_unlock(&player->lock);
    return ready ? (int)(frame % PLAYER_BUFFERS) : -1;
}
