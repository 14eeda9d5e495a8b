// Tiles take turns by strips, `period` of them across the image: so no frame has all the work, and what one frame redraws
// lies together, where few submodels are. Scattered tiles touch nearly all of them in every frame.

uint strip_of(uint tile_x, uint width, uint period)
{
    return tile_x * period / ((width + SHARED_TILE - 1) / SHARED_TILE);
}

bool tile_has_turn(uint tile_x, uint width, uint turn, uint period)
{
    return (turn + strip_of(tile_x, width, period)) % period == 0u;
}
