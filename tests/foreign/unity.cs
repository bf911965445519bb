using UnityEngine;
public class Ball : MonoBehaviour {
  public float radius = 1.25f;
  void Start() {
    Camera.main.transform.position = new Vector3(3f, 3.5f, -8f);
    Camera.main.fieldOfView = 45f;
    transform.localScale = new Vector3(2f * radius, 2.5f, 2.5f);
  }
}
