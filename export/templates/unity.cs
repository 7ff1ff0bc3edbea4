// untested in Unity.  @name@, made by krs @version@: put it beside @stem@.shader and @stem@.hlsl, and on an empty object.
//
// It makes the box around the scene, its material, and sets parameters and the time.  Colours are those of a colour picker.
using UnityEngine;

[ExecuteAlways, RequireComponent(typeof(MeshFilter), typeof(MeshRenderer))]
public class @unity_class@ : MonoBehaviour
{
@unity_fields@    public bool moves = true; // by the time
@if_baked@    public TextAsset samples; // drag @stem@.bytes to here

    Texture3D texture; // of them
@end@
    MaterialPropertyBlock block;

    void OnEnable()
    {
        block = new MaterialPropertyBlock();
        GetComponent<MeshFilter>().sharedMesh = MakeBox(new Vector3(@unity_center@), new Vector3(@unity_half@));
        GetComponent<MeshRenderer>().sharedMaterial = new Material(Shader.Find("krs/@stem@"));
@if_baked@        texture = null;
@end@    }

    void Update()
    {
@if_baked@        if (texture == null && samples != null)
            GetComponent<MeshRenderer>().sharedMaterial.SetTexture("krs_baked", texture = MakeSamples());
@end@        block.SetFloat("_KrsTime", moves ? Time.time : 0f);
@unity_sets@        GetComponent<MeshRenderer>().SetPropertyBlock(block);
    }

@if_baked@    // A texture of the file, behind its 148 bytes of a DDS header.
    Texture3D MakeSamples()
    {
        var texture = new Texture3D(@baked_count@, TextureFormat.RGBAHalf, false) { wrapMode = TextureWrapMode.Clamp, filterMode = FilterMode.Bilinear };
        texture.SetPixelData(samples.bytes, 0, 148);
        texture.Apply(false, true);
        return texture;
    }

@end@    static Mesh MakeBox(Vector3 middle, Vector3 half)
    {
        var corners = new Vector3[8];
        for (int i = 0; i < 8; i++)
            corners[i] = middle + new Vector3((i & 1) == 0 ? -half.x : half.x, (i & 2) == 0 ? -half.y : half.y, (i & 4) == 0 ? -half.z : half.z);
        var box = new Mesh { name = "@stem@", vertices = corners };
        box.triangles = new[] { 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5 };
        box.RecalculateBounds();
        return box;
    }
}
