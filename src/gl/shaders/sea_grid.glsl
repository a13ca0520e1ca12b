/* sea_grid.glsl - the mesh of a sea: a fan around the eye whose cells are some pixels wide, and waves' height long where they are far away. */
/* Where the water of a node rests. Near the eye, where water moves farther than it is away, the fan is wider than the picture. */
vec2 sea_grid_rest(ivec2 node)
{
    float waves = sea_fan_ends.y;
    float row = float(node.y);
    float r = sea_fan.z * sinh(sea_fan.w * min(row, sea_fan_level.x));
    r *= pow(sea_fan_ends.w, max(row - waves, 0.0)) / max(1.0 - sea_fan.w * max(min(row, waves) - sea_fan_level.x, 0.0), 0.5 * sea_fan.w);
    float wider = asin(min(1.2 * sea_shift.z / max(r, 1e-6), 1.0));
    float azimuth = sea_fan.x + (2.0 * float(node.x) / (sea_fan_ends.x - 1.0) - 1.0) * min(sea_fan.y + wider, PI);
    return sea_shift.xy + r * vec2(cos(azimuth), sin(azimuth));
}
