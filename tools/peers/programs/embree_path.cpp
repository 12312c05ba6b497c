// Path tracer on Embree 4 with next-event estimation of the sun: nadir image of one band.
//
//   embree_path SCENE.bin SAMPLES SEED IMAGE.bin THREADS ISA
//
// Single rays, two levels (one tree of the plant, one of its instances), high-quality builds. Prints one line:
// build seconds, tracing seconds, rays. The scene file, little-endian, is written by `embree.py`.
#include <embree4/rtcore.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <pmmintrin.h>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>
#include <xmmintrin.h>

namespace {

constexpr float kPi = 3.14159265f;
// Distance that rays start from the surface that they leave, m.
constexpr float kOffset = 1e-4f;
// Scattering events before Russian roulette, and the highest probability to survive it: that of dim paths is their throughput.
constexpr int kRouletteDepth = 3;
constexpr float kHighestSurvival = 0.95f;

struct Vec {
    float x, y, z;
    Vec operator+(Vec b) const { return {x + b.x, y + b.y, z + b.z}; }
    Vec operator*(float s) const { return {x * s, y * s, z * s}; }
};
float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec normalized(Vec a) { return a * (1.0f / std::sqrt(dot(a, a))); }

// PCG32 (O'Neill 2014).
class Random {
  public:
    Random(uint64_t seed, uint64_t stream) : increment_(2 * stream + 1) {
        next();
        state_ += seed;
        next();
    }
    float uniform() { return static_cast<float>(next() >> 8) * 0x1p-24f; }

  private:
    uint32_t next() {
        const uint64_t old = state_;
        state_ = old * 6364136223846793005ull + increment_;
        const auto shifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
        const auto turn = static_cast<uint32_t>(old >> 59);
        return (shifted >> turn) | (shifted << ((32 - turn) & 31));
    }
    uint64_t state_ = 0, increment_;
};

struct Surface { float reflectance, transmittance; };
struct Place { float x, y, z, yaw; };
struct Header {
    uint32_t parts, places, pixels;
    float size, extent, sun_zenith;
};

struct Scene {
    Header header{};
    Surface soil{};
    std::vector<Surface> surfaces;              // by part
    std::vector<std::vector<float>> triangles;  // by part, nine coordinates each
    std::vector<Place> places;

    explicit Scene(const std::string& path) {
        std::ifstream file(path, std::ios::binary);
        const auto read = [&](auto* data, size_t count) {
            file.read(reinterpret_cast<char*>(data), static_cast<std::streamsize>(count * sizeof *data));
            if (!file) throw std::runtime_error("cannot read " + path);
        };
        read(&header, 1);
        read(&soil, 1);
        surfaces.resize(header.parts);
        triangles.resize(header.parts);
        for (uint32_t part = 0; part < header.parts; part++) {
            uint32_t count = 0;
            read(&surfaces[part], 1);
            read(&count, 1);
            triangles[part].resize(9 * size_t{count});
            read(triangles[part].data(), triangles[part].size());
        }
        places.resize(header.places);
        read(places.data(), places.size());
    }
};

void attach_triangles(RTCDevice device, RTCScene scene, const std::vector<float>& corners, unsigned id) {
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const size_t count = corners.size() / 9;
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 3 * count));
    auto* indices = static_cast<uint32_t*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, count));
    for (size_t i = 0; i < corners.size(); i++) vertices[i] = corners[i];
    for (size_t i = 0; i < 3 * count; i++) indices[i] = static_cast<uint32_t>(i);
    rtcSetGeometryBuildQuality(mesh, RTC_BUILD_QUALITY_HIGH);
    rtcCommitGeometry(mesh);
    rtcAttachGeometryByID(scene, mesh, id);
    rtcReleaseGeometry(mesh);
}

RTCScene build(RTCDevice device, const Scene& scene) {
    RTCScene plant = rtcNewScene(device);
    rtcSetSceneBuildQuality(plant, RTC_BUILD_QUALITY_HIGH);
    for (uint32_t part = 0; part < scene.header.parts; part++)
        attach_triangles(device, plant, scene.triangles[part], part);
    rtcCommitScene(plant);
    RTCScene top = rtcNewScene(device);
    rtcSetSceneBuildQuality(top, RTC_BUILD_QUALITY_HIGH);
    const float s = scene.header.size;
    attach_triangles(device, top, {0, 0, 0, s, 0, 0, s, s, 0, 0, 0, 0, s, s, 0, 0, s, 0}, 0);
    for (uint32_t i = 0; i < scene.header.places; i++) {
        const Place& place = scene.places[i];
        const float c = std::cos(place.yaw), n = std::sin(place.yaw);
        const float columns[12] = {c, n, 0, -n, c, 0, 0, 0, 1, place.x, place.y, place.z};
        RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, plant);
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        rtcCommitGeometry(instance);
        rtcAttachGeometryByID(top, instance, i + 1);
        rtcReleaseGeometry(instance);
    }
    rtcCommitScene(top);
    return top;
}

RTCRay ray_from(Vec origin, Vec direction, float start) {
    RTCRay ray{};
    ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tnear = start, ray.tfar = std::numeric_limits<float>::infinity(), ray.mask = ~0u;
    return ray;
}

// Direction with a density of cosine over pi around the normal.
Vec cosine_direction(Vec normal, Random& random) {
    const float u = random.uniform(), angle = 2 * kPi * random.uniform();
    const float radius = std::sqrt(u), sign = std::copysign(1.0f, normal.z);
    const float a = -1.0f / (sign + normal.z), b = normal.x * normal.y * a;  // Duff et al. (2017)
    const Vec first{1 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
    const Vec second{b, sign + normal.y * normal.y * a, -normal.y};
    return first * (radius * std::cos(angle)) + second * (radius * std::sin(angle)) + normal * std::sqrt(1 - u);
}

class Tracer {
  public:
    Tracer(RTCScene top, const Scene& scene) : top_(top), scene_(scene) {
        const float zenith = scene.header.sun_zenith;
        sun_ = {-std::sin(zenith), 0, std::cos(zenith)};
        for (const Place& place : scene.places) turns_.push_back({std::cos(place.yaw), std::sin(place.yaw), 0});
    }

    // Reflectance factor times the cosine of the sun's zenith angle, along one path.
    float path(Vec origin, Vec direction, Random& random, uint64_t& rays) const {
        float throughput = 1, radiance = 0;
        for (int depth = 0;; depth++) {
            RTCRayHit hit{};
            hit.ray = ray_from(origin, direction, depth ? kOffset : 0);
            hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(top_, &hit);
            rays++;
            if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return radiance;
            Vec normal{hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z};
            Surface surface = scene_.soil;
            if (hit.hit.instID[0] != RTC_INVALID_GEOMETRY_ID) {
                const Vec turn = turns_[hit.hit.instID[0] - 1];
                normal = {turn.x * normal.x - turn.y * normal.y, turn.y * normal.x + turn.x * normal.y, normal.z};
                surface = scene_.surfaces[hit.hit.geomID];
            }
            normal = normalized(normal);
            if (dot(normal, direction) > 0) normal = normal * -1;
            origin = origin + direction * hit.ray.tfar;
            const float cosine = dot(normal, sun_);
            const float scattered = cosine > 0 ? surface.reflectance * cosine : -surface.transmittance * cosine;
            if (scattered > 0) {
                RTCRay shadow = ray_from(origin, sun_, kOffset);
                rtcOccluded1(top_, &shadow);
                rays++;
                if (shadow.tfar >= 0) radiance += throughput * scattered;
            }
            const float albedo = surface.reflectance + surface.transmittance;
            throughput *= albedo;
            if (depth >= kRouletteDepth) {
                const float survival = std::min(kHighestSurvival, throughput);
                if (random.uniform() >= survival) return radiance;
                throughput /= survival;
            }
            if (throughput <= 0) return radiance;
            const bool is_transmitted = random.uniform() * albedo >= surface.reflectance;
            direction = cosine_direction(is_transmitted ? normal * -1 : normal, random);
        }
    }

  private:
    RTCScene top_;
    const Scene& scene_;
    Vec sun_{};
    std::vector<Vec> turns_;  // cosine and sine of each instance's rotation
};

// Traces the image with all threads, row by row; row 0 is the northern one. Returns the number of rays.
uint64_t render(const Tracer& tracer, const Scene& scene, int samples, uint64_t seed, unsigned threads,
                std::vector<float>& image) {
    const uint32_t pixels = scene.header.pixels;
    const float side = scene.header.extent / static_cast<float>(pixels);
    const float corner = (scene.header.size - scene.header.extent) / 2;
    const float scale = 1 / (static_cast<float>(samples) * std::cos(scene.header.sun_zenith));
    std::atomic<uint32_t> next{0};
    std::atomic<uint64_t> all{0};
    const auto work = [&] {
        _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
        _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
        uint64_t rays = 0;
        for (uint32_t row; (row = next++) < pixels;) {
            Random random(seed, row);
            const float north = corner + side * static_cast<float>(pixels - row);
            for (uint32_t column = 0; column < pixels; column++) {
                float sum = 0;
                for (int sample = 0; sample < samples; sample++) {
                    const float x = corner + side * (static_cast<float>(column) + random.uniform());
                    const float y = north - side * random.uniform();
                    sum += tracer.path({x, y, 100}, {0, 0, -1}, random, rays);
                }
                image[size_t{row} * pixels + column] = sum * scale;
            }
        }
        all += rays;
    };
    std::vector<std::thread> pool;
    for (unsigned i = 0; i < threads; i++) pool.emplace_back(work);
    for (std::thread& thread : pool) thread.join();
    return all;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int count, char** arguments) try {
    if (count != 7) throw std::runtime_error("usage: embree_path SCENE.bin SAMPLES SEED IMAGE.bin THREADS ISA");
    const Scene scene(arguments[1]);
    const auto threads = static_cast<unsigned>(std::stoul(arguments[5]));
    const std::string settings = "threads=" + std::to_string(threads) + ",isa=" + arguments[6];
    auto start = std::chrono::steady_clock::now();
    RTCDevice device = rtcNewDevice(settings.c_str());
    if (!device) throw std::runtime_error("no Embree device with " + settings);
    if (rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION) != RTC_VERSION)
        throw std::runtime_error("library and headers of Embree differ in version");
    RTCScene top = build(device, scene);
    const double build_seconds = seconds_since(start);
    std::vector<float> image(size_t{scene.header.pixels} * scene.header.pixels);
    const Tracer tracer(top, scene);
    start = std::chrono::steady_clock::now();
    const uint64_t rays = render(tracer, scene, std::stoi(arguments[2]), std::stoull(arguments[3]), threads, image);
    std::printf("%.6f %.6f %llu\n", build_seconds, seconds_since(start), static_cast<unsigned long long>(rays));
    std::ofstream(arguments[4], std::ios::binary)
        .write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(image.size() * sizeof(float)));
    rtcReleaseScene(top);
    rtcReleaseDevice(device);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "embree_path: %s\n", error.what());
    return 1;
}
