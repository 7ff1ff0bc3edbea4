# Untested.  A formula for Homebrew on Linux: put krs-0.2.0.tar.gz of `make dist` beside it.
class Krs < Formula
  desc "Compiler and renderer of scenes of implicit surfaces"
  license "MIT"
  url "file://#{__dir__}/krs-0.2.0.tar.gz"
  version "0.2.0"

  depends_on "pkgconf" => :build
  depends_on "vulkan-headers" => :build
  depends_on "xxhash" => :build
  depends_on "chafa"
  depends_on "expat"
  depends_on "fontconfig"
  depends_on "freetype"
  depends_on "glfw"
  depends_on "glslang"
  depends_on "harfbuzz"
  depends_on "imgui"
  depends_on "jansson"
  depends_on "libdeflate"
  depends_on "libpng"
  depends_on "libseccomp"
  depends_on "libx11"
  depends_on "libzip"
  depends_on :linux
  depends_on "meshoptimizer"
  depends_on "openexr"
  depends_on "qhull"
  depends_on "spirv-tools"
  depends_on "tinygltf"
  depends_on "vulkan-loader"

  def install
    system "make", "all"
    system "make", "install", "PREFIX=#{prefix}"
  end

  test do
    (testpath/"ball.krs").write "show sphere(1);"
    system bin/"krs", "check", "ball.krs"
  end
end
