//! Antialiasing: a list of the pixels of a picture that have edges, and several rays through each of them.

use super::eye_pass::EyePass;
use super::light_lookup::LightLookup;
use super::ray_target::{DrawnRay, RayTarget};
use crate::GpuError;
use crate::output::render_target::{AntialiasedLight, EDGE_LIST_HEADER};
use crate::pipelines::binding::{bind_buffer, bind_view};
use crate::pipelines::pipeline_variant::SingleVariant;
use crate::pipelines::uniforms;
use crate::plan::PixelRay;
use crate::resources::pass;
use crate::volume::VolumeContext;
use crate::volume::transfer_tables::TransferTables;
use chiaroscuro_scene::Settings;

/// Factor by which a submission has fewer rows than in the eye pass: of the pixels of a picture that is full of edges
/// one in four has some, and is drawn with up to sixteen rays.
pub(crate) const ROW_COST: u32 = 4;

/// Shader that finds edges.
pub(crate) const EDGES: SingleVariant = SingleVariant("eye/edges.wgsl");

/// Rays through the pixels with edges of a picture.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EdgeRays<'a> {
    pub eye: &'a EyePass,
    pub settings: &'a Settings,
    /// Number of rays through each sample at edges.
    pub count: u32,
}

impl EdgeRays<'_> {
    /// Draws some rows of the antialiased picture from those of the picture with rays through the middles of pixels.
    pub(crate) fn draw(
        self,
        gpu: VolumeContext<'_>,
        tables: &TransferTables,
        looked_up: LightLookup<'_>,
        (middles, antialiased): (&wgpu::TextureView, &AntialiasedLight),
        rows: std::ops::Range<u32>,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), GpuError> {
        let frame = self.eye.frame();
        let extent = uniforms::EdgesUniform {
            size: frame.size,
            first_row: rows.start,
            end_row: rows.end,
            min_contrast: PixelRay::min_contrast(self.count) as f32,
            pad0: 0,
            pad1: 0,
            pad2: 0,
        };
        let extent = gpu.uniform("Edges::uniform", extent);
        let pipeline = gpu.shaders.pipeline(&EDGES)?;
        let group = gpu.bind(
            "Edges::bind_group",
            &pipeline,
            0,
            &[
                bind_buffer("bound_edges", &extent),
                bind_view("middles", middles),
                bind_view("picture", &antialiased.plane.view),
                bind_buffer("edge_list", &antialiased.edges),
            ],
        );
        encoder.clear_buffer(&antialiased.edges, 0, Some(EDGE_LIST_HEADER));
        let tiles = pass::tile_workgroups([frame.size[0], rows.end - rows.start]);
        pass::dispatch(encoder, "Edges::pass", &pipeline, &[&group], tiles);
        // Sums move from one plane to the other, and end in that of the result: numbers of rays are even.
        let planes = [&antialiased.sums.view, &antialiased.plane.view];
        let rays = PixelRay::set(self.count);
        for (at, ray) in rays.iter().enumerate() {
            let moved = frame.for_pixel_ray(*ray, self.settings);
            let [right, down] = ray.offset.map(|offset| offset as f32);
            let shift = (moved.first_depth - frame.first_depth) as f32;
            let [picture, earlier] = if at % 2 == 0 { planes } else { [planes[1], planes[0]] };
            let ray = DrawnRay {
                target: RayTarget { picture, earlier, edges: &antialiased.edges },
                ray: uniforms::PixelRayUniform {
                    place: [right, down, shift, 1.0 / rays.len() as f32],
                    is_listed: 1,
                    is_added: u32::from(at > 0),
                    pad0: 0,
                    pad1: 0,
                },
                slab_count: moved.slab_count,
            };
            self.eye.cast_rays(gpu, tables, looked_up, ray, rows.clone(), encoder)?;
        }
        Ok(())
    }
}
