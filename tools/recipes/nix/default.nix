# Untested.  For Nix: nix-build in a clone of the sources.
{ pkgs ? import <nixpkgs> { } }:
pkgs.stdenv.mkDerivation {
  pname = "krs";
  version = "0.2.0";
  src = ../../..;
  nativeBuildInputs = with pkgs; [ pkg-config glslang spirv-tools ];
  buildInputs = with pkgs; [
    chafa expat fontconfig freetype glfw glslang harfbuzz imgui jansson libdeflate libpng libseccomp libzip meshoptimizer openexr
    qhull spirv-tools tinygltf vulkan-headers vulkan-loader libGL xorg.libX11 xxHash
  ];
  enableParallelBuilding = true;
  makeFlags = [ "PREFIX=$(out)" ];
  buildFlags = [ "all" ];
  meta = with pkgs.lib; {
    description = "Compiler and renderer of scenes of implicit surfaces";
    license = licenses.mit;
    platforms = platforms.linux;
    mainProgram = "krs";
  };
}
