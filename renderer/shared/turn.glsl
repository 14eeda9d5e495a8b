// Tiles take turns: neighbours differ, by the golden ratio's multiples in both directions.
bool tile_has_turn(uvec2 tile, uint eye, uint turn, uint period)
{
    uint phase = tile.x * 2654435769u + tile.y * 1640531527u + eye * 40503u;
    return (turn + (phase >> 16)) % period == 0u;
}
