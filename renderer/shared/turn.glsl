// Tiles take turns by strips, `period` of them across the image: so no frame has all the work, and what one frame redraws
// lies together, where few submodels are. Scattered tiles touch nearly all of them in every frame.
bool tile_has_turn(uint tile_x, uint width, uint turn, uint period)
{
    uint strip = tile_x * period / ((width + SHARED_TILE - 1) / SHARED_TILE);
    return (turn + strip) % period == 0u;
}
