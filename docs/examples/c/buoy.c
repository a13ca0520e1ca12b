/* buoy.c - how a buoy moves in a breeze: cc buoy.c $(pkg-config --cflags --libs facet) && ./a.out */
#include <stdio.h>

#include <facet/facet.h>

int main(void)
{
    facet_error error;
    facet_sea_desc desc;
    facet_sea *sea = NULL;
    if (facet_sea_preset("breeze", &desc, &error) != FACET_OK ||
        facet_sea_create(&desc, &sea, &error) != FACET_OK) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }
    const double place[2] = {12.0, -3.0}; /* along +X and +Z, m */
    printf("significant height %.2f m\n", facet_sea_get_info(sea).height_m);
    for (int i = 0; i < 20; i++) {
        facet_sea_point p;
        if (facet_sea_set_time(sea, 0.25 * i, &error) != FACET_OK)
            break;
        facet_sea_get_points(sea, place, 1, &p);
        printf("%5.2f s: %+.3f m, %+.3f m/s, leaning %+.3f along x\n", 0.25 * i, (double)p.height_m,
               (double)p.velocity_mps, (double)p.normal[0]);
    }
    facet_sea_destroy(sea);
    return 0;
}
