/* VolPack on voxels that were shaded and classified already: a picture for every azimuth read.
 *
 * volpack FILE NX NY NZ Z_SPACING WIDTH ELEVATION MIN_OPACITY MAX_OPACITY
 *
 * FILE holds opacity and grey, a byte each, voxel by voxel. For every line on standard input, an azimuth in degrees, it
 * writes "milliseconds 1" and a newline, and then WIDTH x WIDTH bytes of linear grey, the top row first.
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <volpack.h>

typedef struct {
    short grey;
    unsigned char opacity, unused;
} Voxel;

static vpContext *context;

static void must(vpResult result, const char *what)
{
    if (result != VP_OK) {
        fprintf(stderr, "volpack: %s: %s\n", what, vpGetErrorString(vpGetError(context)));
        exit(1);
    }
}

static double milliseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * 1e3 + now.tv_nsec * 1e-6;
}

static Voxel *read_voxels(const char *path, size_t count)
{
    Voxel *voxels = malloc(count * sizeof *voxels);
    FILE *file = fopen(path, "rb");
    unsigned char pair[2];
    if (!voxels || !file) {
        fprintf(stderr, "volpack: %s cannot be read\n", path);
        exit(1);
    }
    for (size_t i = 0; i < count; i++) {
        if (fread(pair, 1, 2, file) != 2) {
            fprintf(stderr, "volpack: %s ends after %zu of %zu voxels\n", path, i, count);
            exit(1);
        }
        voxels[i] = (Voxel){ .grey = pair[1], .opacity = pair[0] };
    }
    fclose(file);
    return voxels;
}

static float ramp[256], shades[256];

/* The volume as VolPack keeps it: runs of voxels that are not clear, for each axis. */
static void classify(Voxel *voxels, int nx, int ny, int nz, double least, double most)
{
    Voxel *field = NULL;
    for (int i = 0; i < 256; i++) {
        ramp[i] = i / 255.0f;
        shades[i] = i;
    }
    must(vpSetVolumeSize(context, nx, ny, nz), "size");
    must(vpSetVoxelSize(context, sizeof *voxels, 2, 1, 1), "voxel");
    must(vpSetVoxelField(context, 0, 2, vpFieldOffset(field, grey), 255), "grey");
    must(vpSetVoxelField(context, 1, 1, vpFieldOffset(field, opacity), 255), "opacity");
    must(vpSetRawVoxels(context, voxels, nx * ny * nz * sizeof *voxels, sizeof *voxels,
                        nx * sizeof *voxels, nx * ny * sizeof *voxels), "voxels");
    must(vpSetClassifierTable(context, 0, 1, ramp, sizeof ramp), "classifier");
    must(vpSetd(context, VP_MIN_VOXEL_OPACITY, least), "least opacity");
    must(vpSetd(context, VP_MAX_RAY_OPACITY, most), "most opacity");
    must(vpClassifyVolume(context), "classification");
    must(vpSetLookupShader(context, 1, 1, 0, shades, sizeof shades, 0, NULL, 0), "shader");
}

static double frame(double azimuth, double elevation, double z_spacing)
{
    vpCurrentMatrix(context, VP_MODEL);
    vpIdentityMatrix(context);
    vpScale(context, 1.0, 1.0, z_spacing);
    vpRotate(context, VP_Z_AXIS, azimuth);
    vpRotate(context, VP_X_AXIS, -90.0 - elevation);
    double start = milliseconds();
    must(vpRenderClassifiedVolume(context), "rendering");
    return milliseconds() - start;
}

int main(int count, char **told)
{
    if (count != 10) {
        fprintf(stderr, "volpack: nine arguments are expected\n");
        return 2;
    }
    int nx = atoi(told[2]), ny = atoi(told[3]), nz = atoi(told[4]), width = atoi(told[6]);
    Voxel *voxels = read_voxels(told[1], (size_t)nx * ny * nz);
    unsigned char *image = calloc(width, width);
    context = vpCreateContext();
    classify(voxels, nx, ny, nz, atof(told[8]), atof(told[9]));
    vpSeti(context, VP_CONCAT_MODE, VP_CONCAT_LEFT);
    vpCurrentMatrix(context, VP_PROJECT);
    vpIdentityMatrix(context);
    vpWindow(context, VP_PARALLEL, -0.5, 0.5, -0.5, 0.5, -1.0, 1.0);
    must(vpSetImage(context, image, width, width, width, VP_LUMINANCE), "image");
    char line[64];
    while (fgets(line, sizeof line, stdin)) {
        printf("%.6f 1\n", frame(atof(line), atof(told[7]), atof(told[5])));
        fwrite(image, width, width, stdout);
        fflush(stdout);
    }
    return 0;
}
