#include "sim/objects/triangle_mesh.hpp"

namespace alight::sim {

void TriangleMesh::add_triangle(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                                std::uint16_t surface) {
  const Eigen::Vector3f normal = (b - a).cross(c - a).normalized();
  const auto first = static_cast<std::uint32_t>(vertices.size());
  for (const Eigen::Vector3f& vertex : {a, b, c}) {
    vertices.push_back(vertex);
    normals.push_back(normal);
  }
  triangles.push_back({first, first + 1, first + 2});
  triangle_surfaces.push_back(surface);
}

void TriangleMesh::add_quad(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c,
                            const Eigen::Vector3f& d, std::uint16_t surface) {
  add_triangle(a, b, c, surface);
  add_triangle(a, c, d, surface);
}

void TriangleMesh::append(const TriangleMesh& other, const Eigen::Affine3f& T) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  const Eigen::Matrix3f normal_matrix = T.linear().inverse().transpose();
  for (const Eigen::Vector3f& vertex : other.vertices) vertices.push_back(T * vertex);
  for (const Eigen::Vector3f& normal : other.normals)
    normals.push_back((normal_matrix * normal).normalized());
  for (const auto& t : other.triangles) triangles.push_back({first + t[0], first + t[1], first + t[2]});
  triangle_surfaces.insert(triangle_surfaces.end(), other.triangle_surfaces.begin(),
                           other.triangle_surfaces.end());
}

}  // namespace alight::sim
