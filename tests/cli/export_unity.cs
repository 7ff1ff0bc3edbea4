// What the script for Unity asks of that: a stand-in, to compile it by.
using System;
namespace UnityEngine
{
    public class ExecuteAlways : Attribute { }
    public class RequireComponent : Attribute { public RequireComponent(Type a, Type b) { } }
    public class Range : Attribute { public Range(float low, float high) { } }
    public struct Vector3 { public float x, y, z; public Vector3(float a, float b, float c) { x = a; y = b; z = c; }
        public static Vector3 operator +(Vector3 a, Vector3 b) { return a; } }
    public struct Vector4 { public Vector4(float a, float b, float c, float d) { } }
    public struct Color { public Color(float r, float g, float b, float a) { } }
    public class Object { public string name { get; set; } }
    public class Mesh : Object { public Vector3[] vertices { get; set; } public int[] triangles { get; set; } public void RecalculateBounds() { } }
    public class Shader : Object { public static Shader Find(string name) { return null; } }
    public class Material : Object { public Material(Shader shader) { } }
    public class MaterialPropertyBlock
    {
        public void SetFloat(string name, float value) { }
        public void SetColor(string name, Color value) { }
        public void SetVector(string name, Vector4 value) { }
    }
    public class Component : Object { public T GetComponent<T>() { return default(T); } }
    public class MonoBehaviour : Component { }
    public class MeshFilter : Component { public Mesh sharedMesh { get; set; } }
    public class MeshRenderer : Component { public Material sharedMaterial { get; set; } public void SetPropertyBlock(MaterialPropertyBlock block) { } }
    public static class Time { public static float time { get { return 0; } } }
}
